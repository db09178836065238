#include "core/recording/ros/mcap_writer.h"

#include "core/recording/recording_writer.h"
#include "core/recording/ros/compression.h"
#include "core/recording/ros/mcap_records.h"
#include "core/recording/ros/message_cursor.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

namespace evical {
namespace {

using mcap::record;
using ros::sized;

constexpr std::size_t kChunk_bytes = 1 << 20;
constexpr std::int64_t kMcapSecondsEnd = std::int64_t{1} << 31;  // int32 sec

std::uint32_t crcOf(std::uint32_t crc, std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint16_t idOf(std::size_t stream) {
  return static_cast<std::uint16_t>(stream + 1);  // 0 means no schema
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
                       McapCompression compression)
    : RosWriter(path, streams, ros::Serialization::Cdr, kMcapSecondsEnd),
      file_(path),
      compression_(compression),
      channels_(streams.size()) {
  file_.append(mcap::kMagic);
  file_.append(record(mcap::Op::Header, sized("ros2") + sized("evical")));
}

void McapWriter::finish() {
  flushEvents();
  flushChunk();
  file_.append(record(mcap::Op::DataEnd, numberBytes(std::uint32_t{0})));  // no checksum
  appendSummary();
  file_.append(mcap::kMagic);
  file_.finish();
}

void McapWriter::flush() {
  flushEvents();
  flushChunk();
  file_.publish();
}

// All streams before the first message, so that readers know them; the type of frames follows from the first
// one.
void McapWriter::announce(std::size_t stream) {
  if (channels_[stream].announced) return;
  for (std::size_t i = 0; i < streamCount(); ++i) {
    if (channels_[i].announced || (i != stream && info(i).type == StreamType::Frames)) continue;
    channels_[i].announced = true;
    chunk_ += schemaRecord(i) + channelRecord(i);
  }
}

void McapWriter::appendMessage(std::size_t stream, std::uint32_t sequence, std::int64_t time_ns,
                               std::string_view message) {
  announce(stream);
  Channel& channel = channels_[stream];
  ++channel.messages;
  const auto time = static_cast<std::uint64_t>(time_ns);
  channel.index.emplace_back(time, chunk_.size());
  constexpr std::uint64_t kHead_bytes = 2 + 4 + 8 + 8;
  chunk_ += numberBytes(mcap::Op::Message) + numberBytes(kHead_bytes + message.size()) +
            numberBytes(idOf(stream)) + numberBytes(sequence) + numberBytes(time) + numberBytes(time);
  chunk_ += message;
  if (chunk_.size() >= kChunk_bytes) flushChunk();
}

void McapWriter::flushChunk() {
  if (chunk_.empty()) return;
  ChunkInfo info;
  info.position = file_.size();
  info.first_ns = std::numeric_limits<std::uint64_t>::max();
  for (const Channel& channel : channels_) {
    for (const auto& [time, offset] : channel.index) {
      info.first_ns = std::min(info.first_ns, time);
      info.last_ns = std::max(info.last_ns, time);
    }
  }
  if (compression_ == McapCompression::Lz4) ros::packLz4(chunk_, packed_);
  if (compression_ == McapCompression::Zstd) ros::packZstd(chunk_, packed_);
  const std::string& data = compression_ == McapCompression::None ? chunk_ : packed_;
  info.plain_bytes = chunk_.size();
  info.packed_bytes = data.size();
  const std::string head = numberBytes(info.first_ns) + numberBytes(info.last_ns) +
                           numberBytes(info.plain_bytes) + numberBytes(crcOf(0, chunk_)) +
                           sized(compressionName()) + numberBytes(info.packed_bytes);
  file_.append(numberBytes(mcap::Op::Chunk) + numberBytes(std::uint64_t{head.size() + data.size()}) + head);
  file_.append(data);
  info.size = file_.size() - info.position;
  appendIndexes(info);
  chunks_.push_back(std::move(info));
  chunk_.clear();
}

void McapWriter::appendIndexes(ChunkInfo& chunk) {
  const std::uint64_t begin = file_.size();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    auto& index = channels_[i].index;
    if (index.empty()) continue;
    std::sort(index.begin(), index.end());
    std::string entries;
    for (const auto& [time, offset] : index) entries += numberBytes(time) + numberBytes(offset);
    chunk.index_offsets += numberBytes(idOf(i)) + numberBytes(file_.size());
    file_.append(record(mcap::Op::MessageIndex, numberBytes(idOf(i)) + sized(entries)));
    index.clear();
  }
  chunk.index_bytes = file_.size() - begin;
}

// Writes groups of records of one kind, their positions, and the footer with a checksum of all of them.
void McapWriter::appendSummary() {
  const std::uint64_t start = file_.size();
  std::string summary, offsets;
  const auto group = [&](mcap::Op op, const std::string& records) {
    if (records.empty()) return;
    offsets += record(mcap::Op::SummaryOffset, numberBytes(op) + numberBytes(start + summary.size()) +
                                                   numberBytes(std::uint64_t{records.size()}));
    summary += records;
  };
  std::string schemas, channels, indexes;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    schemas += schemaRecord(i);
    channels += channelRecord(i);
  }
  for (const ChunkInfo& chunk : chunks_) indexes += chunkIndexRecord(chunk);
  group(mcap::Op::Schema, schemas);
  group(mcap::Op::Channel, channels);
  group(mcap::Op::Statistics, statisticsRecord());
  group(mcap::Op::ChunkIndex, indexes);
  std::string footer = numberBytes(mcap::Op::Footer) + numberBytes(std::uint64_t{20}) + numberBytes(start) +
                       numberBytes(start + summary.size());
  summary += offsets;
  footer += numberBytes(crcOf(crcOf(0, summary), footer));
  file_.append(summary);
  file_.append(footer);
}

const char* McapWriter::compressionName() const {
  if (compression_ == McapCompression::Lz4) return "lz4";
  return compression_ == McapCompression::Zstd ? "zstd" : "";
}

std::string McapWriter::schemaRecord(std::size_t stream) const {
  const ros::MessageType& type = messageType(stream);
  return record(mcap::Op::Schema,
                numberBytes(idOf(stream)) + sized(type.name) + sized("ros2msg") + sized(type.definition));
}

std::string McapWriter::channelRecord(std::size_t stream) const {
  return record(mcap::Op::Channel, numberBytes(idOf(stream)) + numberBytes(idOf(stream)) +
                                       sized(info(stream).name) + sized("cdr") + sized(""));
}

std::string McapWriter::chunkIndexRecord(const ChunkInfo& chunk) const {
  return record(mcap::Op::ChunkIndex, numberBytes(chunk.first_ns) + numberBytes(chunk.last_ns) +
                                          numberBytes(chunk.position) + numberBytes(chunk.size) +
                                          sized(chunk.index_offsets) + numberBytes(chunk.index_bytes) +
                                          sized(compressionName()) + numberBytes(chunk.packed_bytes) +
                                          numberBytes(chunk.plain_bytes));
}

std::string McapWriter::statisticsRecord() const {
  std::uint64_t messages = 0, first_ns = 0, last_ns = 0;
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    messages += channels_[i].messages;
    counts += numberBytes(idOf(i)) + numberBytes(channels_[i].messages);
  }
  for (const ChunkInfo& chunk : chunks_) {
    first_ns = first_ns == 0 ? chunk.first_ns : std::min(first_ns, chunk.first_ns);
    last_ns = std::max(last_ns, chunk.last_ns);
  }
  const auto count = [](std::size_t number) { return numberBytes(static_cast<std::uint32_t>(number)); };
  return record(mcap::Op::Statistics,
                numberBytes(messages) + numberBytes(static_cast<std::uint16_t>(channels_.size())) +
                    count(channels_.size()) + count(0) + count(0) + count(chunks_.size()) +
                    numberBytes(first_ns) + numberBytes(last_ns) + sized(counts));
}

std::unique_ptr<RecordingWriter> createMcap(const std::filesystem::path& path,
                                            const std::vector<StreamInfo>& streams,
                                            McapCompression compression) {
  return std::make_unique<McapWriter>(path, streams, compression);
}

}  // namespace evical
