#include "core/recording/prophesee/raw_reader.h"

#include "core/base/time.h"
#include "core/recording/block_reader.h"
#include "core/recording/prophesee/raw_header.h"
#include "core/recording/prophesee/word_decoders.h"

#include <algorithm>
#include <fstream>
#include <utility>

namespace evical {
namespace {

using prophesee::Encoding;
using prophesee::FileHeader;

std::string headerBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(prophesee::kLargestHeader_bytes, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

const char* encodingName(Encoding encoding) {
  switch (encoding) {
    case Encoding::Evt2:
      return "EVT2";
    case Encoding::Evt21:
      return "EVT2.1";
    case Encoding::Evt3:
      return "EVT3";
    case Encoding::Dat:
      break;
  }
  return "DAT";
}

std::unique_ptr<BlockDecoder> decoderFor(const FileHeader& header, std::string_view data) {
  switch (header.encoding) {
    case Encoding::Evt2:
      return std::make_unique<prophesee::Evt2Decoder>(header.resolution_px);
    case Encoding::Evt21: {
      const bool exchanged = header.half_order == prophesee::HalfOrder::Unknown
                                 ? prophesee::looksExchanged(data)
                                 : header.half_order == prophesee::HalfOrder::Exchanged;
      return std::make_unique<prophesee::Evt21Decoder>(header.resolution_px, exchanged);
    }
    case Encoding::Evt3:
      return std::make_unique<prophesee::Evt3BlockDecoder>(header.resolution_px);
    case Encoding::Dat:
      break;
  }
  return std::make_unique<prophesee::DatDecoder>(header);
}

StreamInfo rawStream(StreamType type, const FileHeader& header) {
  StreamInfo stream;
  stream.name = type == StreamType::Events ? "events" : "triggers";
  stream.type = type;
  stream.message = encodingName(header.encoding);
  if (type == StreamType::Events) stream.resolution_px = header.resolution_px;
  stream.time_unit_ns = kMicrosecond_ns;
  return stream;
}

}  // namespace

std::unique_ptr<RecordingReader> openProphesee(const std::filesystem::path& path) {
  const std::string start = headerBytes(path);
  const FileHeader header = prophesee::parseHeader(path, start);
  const bool dat = header.encoding == Encoding::Dat;
  const bool only_triggers = dat && header.event_type == 14;
  BlockFormat format;
  format.name = dat ? "prophesee_dat" : "prophesee_raw";
  format.data_offset = header.data_offset;
  if (!only_triggers) format.streams.push_back(rawStream(StreamType::Events, header));
  if (only_triggers || !dat) format.streams.push_back(rawStream(StreamType::Triggers, header));
  if (!only_triggers && !header.resolution_px.known()) {
    format.notes.push_back({"events", FaultKind::NoResolution, 0.0,
                            "The header does not state the sensor's size. Set it in the session."});
  }
  return std::make_unique<BlockReader>(
      path, std::move(format),
      decoderFor(header,
                 std::string_view(start).substr(std::min<std::size_t>(header.data_offset, start.size()))));
}

}  // namespace evical
