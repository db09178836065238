#include "core/recording/event_stream/event_stream_reader.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/block_reader.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kHeader_bytes = 20;
enum : unsigned { kGeneric = 0, kDvs = 1, kAtis = 2, kColor = 4 };

class EventStreamDecoder : public BlockDecoder {
 public:
  EventStreamDecoder(const Resolution& size_px, bool atis) : size_px_(size_px), atis_(atis) {}

  std::size_t decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) override {
    EventAppender appender(events);
    appender.reserve(bytes.size() / kEvent_bytes);
    std::size_t at = 0;
    while (at < bytes.size()) {
      const auto first = static_cast<unsigned char>(bytes[at]);
      if (atis_ ? (first & 0xFC) == 0xFC : first >= 0xFE) {
        time_us_ += atis_ ? 63 * (first & 3) : first == 0xFF ? 127 : 0;
        ++at;
        continue;
      }
      if (bytes.size() - at < kEvent_bytes) break;
      time_us_ += first >> (atis_ ? 2 : 1);
      addEvent(first, bytes.data() + at + 1, offset + at, appender);
      at += kEvent_bytes;
    }
    return at;
  }

 private:
  static constexpr std::size_t kEvent_bytes = 5;

  void addEvent(unsigned char first, const char* place, std::uint64_t byte, EventAppender& events) {
    std::uint16_t x = 0, y = 0;
    std::memcpy(&x, place, sizeof x);
    std::memcpy(&y, place + sizeof x, sizeof y);
    if (atis_ && (first & 1) != 0) {
      findings_.exposure.add(byte);
    } else if (x >= size_px_.width_px || y >= size_px_.height_px) {
      findings_.outside.add(byte);
    } else {
      const bool brighter = ((first >> (atis_ ? 1 : 0)) & 1) != 0;
      events.add(time_us_ * kMicrosecond_ns, x, static_cast<unsigned>(size_px_.height_px - 1 - y), brighter);
    }
  }

  Resolution size_px_;
  bool atis_;
  std::int64_t time_us_ = 0;
};

const char* kindName(unsigned kind) {
  switch (kind) {
    case kGeneric:
      return "generic";
    case kDvs:
      return "DVS";
    case kAtis:
      return "ATIS";
    case kColor:
      return "color";
    default:
      return "unknown";
  }
}

}  // namespace

std::unique_ptr<RecordingReader> openEventStream(const std::filesystem::path& path) {
  std::string start(kHeader_bytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  ByteCursor cursor(start);
  cursor.take(kEventStreamMagic.size());
  const unsigned major = cursor.number<std::uint8_t>(), minor = cursor.number<std::uint8_t>();
  cursor.number<std::uint8_t>();  // patch
  const unsigned kind = cursor.number<std::uint8_t>();
  if (cursor.ok() && major != 2) {
    throw badInput(path.string(), fmt::format("this is an Event Stream of version {}.{}", major, minor),
                   "Convert it with the tools of event_stream; only version 2 is supported");
  }
  if (cursor.ok() && kind != kDvs && kind != kAtis) {
    throw badInput(path.string(),
                   fmt::format("this is an Event Stream of {} events (type {})", kindName(kind), kind),
                   "Only DVS and ATIS events can be read");
  }
  const int width_px = cursor.number<std::uint16_t>(), height_px = cursor.number<std::uint16_t>();
  if (!cursor.ok()) {
    throw badInput(path.string(),
                   fmt::format("the header is cut off at byte {} of {}", start.size(), kHeader_bytes),
                   "Copy the file again");
  }
  if (width_px == 0 || height_px == 0) {
    throw badInput(path.string(),
                   fmt::format("the header, at byte 16, states {} x {} pixels", width_px, height_px),
                   "Copy the file again");
  }
  StreamInfo stream;
  stream.name = "events";
  stream.type = StreamType::Events;
  stream.message = kindName(kind);
  stream.resolution_px = {width_px, height_px};
  stream.time_unit_ns = kMicrosecond_ns;
  BlockFormat format;
  format.name = "event_stream";
  format.streams = {stream};
  format.data_offset = kHeader_bytes;
  return std::make_unique<BlockReader>(
      path, std::move(format), std::make_unique<EventStreamDecoder>(stream.resolution_px, kind == kAtis));
}

}  // namespace evical
