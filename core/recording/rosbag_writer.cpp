#include "core/recording/rosbag_writer.h"

#include "core/recording/chunk_compression.h"
#include "core/recording/rosbag_format.h"

#include <algorithm>

namespace evical {
namespace {

constexpr std::size_t kChunkSize = 768 * 1024;  // rosbag's own
constexpr std::int64_t kMessageSpan_ns = 10'000'000;
constexpr std::size_t kMessageEvents = 1U << 18;    // 3.4 MB: rather two messages than one larger
constexpr std::int64_t kEarliestRecordTime_ns = 1;  // ROS rejects records at time 0

}  // namespace

RosbagWriter::RosbagWriter(const std::filesystem::path& path, BagCompression compression)
    : file_(path), compression_(compression) {
  file_.append(kBagMagic);
  writeHeader(0);
}

std::size_t RosbagWriter::addEventStream(const std::string& name, Resolution resolution_px) {
  Stream stream;
  stream.topic = name;
  stream.type = eventArrayType();
  stream.resolution_px = resolution_px;
  streams_.push_back(std::move(stream));
  return streams_.size() - 1;
}

std::size_t RosbagWriter::addImuStream(const std::string& name) {
  Stream stream;
  stream.topic = name;
  stream.type = imuType();
  streams_.push_back(std::move(stream));
  return streams_.size() - 1;
}

void RosbagWriter::write(std::size_t index, EventSpan events) {
  Stream& stream = streams_.at(index);
  for (const Event& event : events) {
    if (!stream.waiting.empty() && (event.time_ns - stream.waiting.front().time_ns >= kMessageSpan_ns ||
                                    stream.waiting.size() >= kMessageEvents))
      writeEventMessage(stream);
    stream.waiting.push_back(event);
  }
}

void RosbagWriter::write(std::size_t index, const ImuSample& sample) {
  Stream& stream = streams_.at(index);
  message_.clear();
  appendImu(message_, stream.sequence, stream.topic, sample);
  writeMessage(stream, sample.time_ns);
}

void RosbagWriter::writeEventMessage(Stream& stream) {
  if (stream.waiting.empty()) return;
  message_.clear();
  appendEventArray(message_, stream.sequence, stream.topic, stream.resolution_px, stream.waiting);
  writeMessage(stream, stream.waiting.back().time_ns);
  stream.waiting.clear();
}

// Puts message_ into the chunk, behind the stream's connection record if that isn't in the bag yet.
void RosbagWriter::writeMessage(Stream& stream, std::int64_t time_ns) {
  const auto id = static_cast<std::size_t>(&stream - streams_.data());
  if (!stream.written) appendConnection(id, chunk_);
  stream.written = true;
  const std::int64_t record_time_ns = std::max(time_ns, kEarliestRecordTime_ns);
  stream.index.push_back({record_time_ns, static_cast<std::uint32_t>(chunk_.size())});
  stream.sequence += 1;
  BagFieldsWriter header;
  header.op(BagOp::Message).number("conn", static_cast<std::uint32_t>(id)).time("time", record_time_ns);
  appendBagRecord(chunk_, header, message_);
  if (chunk_.size() >= kChunkSize) writeChunk();
}

void RosbagWriter::appendConnection(std::size_t id, std::vector<std::uint8_t>& bytes) const {
  const Stream& stream = streams_[id];
  BagFieldsWriter header, data;
  header.op(BagOp::Connection).number("conn", static_cast<std::uint32_t>(id)).text("topic", stream.topic);
  data.text("topic", stream.topic)
      .text("type", stream.type.type)
      .text("md5sum", stream.type.md5)
      .text("message_definition", stream.type.definition);
  appendBagRecord(bytes, header, data.bytes());
}

// The chunk, and behind it where its messages are, stream by stream.
void RosbagWriter::writeChunk() {
  if (chunk_.empty()) return;
  ChunkInfo info;
  info.position = file_.size();
  BagFieldsWriter header;
  header.op(BagOp::Chunk)
      .text("compression", compression_ == BagCompression::Lz4 ? "lz4" : "none")
      .number("size", static_cast<std::uint32_t>(chunk_.size()));
  if (compression_ == BagCompression::Lz4) packLz4(chunk_, packed_);
  scratch_.clear();
  appendBagRecord(scratch_, header, compression_ == BagCompression::Lz4 ? packed_ : chunk_);
  for (std::size_t id = 0; id < streams_.size(); ++id) {
    std::vector<IndexEntry>& index = streams_[id].index;
    if (index.empty()) continue;
    BagFieldsWriter index_header;
    index_header.op(BagOp::IndexData)
        .number("ver", std::uint32_t{1})
        .number("conn", static_cast<std::uint32_t>(id))
        .number("count", static_cast<std::uint32_t>(index.size()));
    std::vector<std::uint8_t> entries;
    for (const IndexEntry& entry : index) {
      appendBagTime(entries, entry.time_ns);
      appendLittleEndian(entries, entry.offset);
      info.start_ns = info.start_ns == 0 ? entry.time_ns : std::min(info.start_ns, entry.time_ns);
      info.end_ns = std::max(info.end_ns, entry.time_ns);
    }
    appendBagRecord(scratch_, index_header, entries);
    appendLittleEndian(info.counts, static_cast<std::uint32_t>(id));
    appendLittleEndian(info.counts, static_cast<std::uint32_t>(index.size()));
    info.connections += 1;
    index.clear();
  }
  file_.append(scratch_);
  chunks_.push_back(std::move(info));
  chunk_.clear();
}

// Always of the same size, so that it can be written again when the index' place is known.
void RosbagWriter::writeHeader(std::uint64_t index_position) {
  const auto connections =
      std::count_if(streams_.begin(), streams_.end(), [](const Stream& s) { return s.written; });
  BagFieldsWriter header;
  header.op(BagOp::BagHeader)
      .number("index_pos", index_position)
      .number("conn_count", static_cast<std::uint32_t>(connections))
      .number("chunk_count", static_cast<std::uint32_t>(chunks_.size()));
  const std::vector<std::uint8_t> padding(
      kBagHeaderRecordSize - 2 * sizeof(std::uint32_t) - header.bytes().size(), ' ');
  std::vector<std::uint8_t> record;
  appendBagRecord(record, header, padding);
  if (index_position == 0)
    file_.append(record);
  else
    file_.overwrite(kBagMagic.size(), record);
}

void RosbagWriter::finish() {
  for (Stream& stream : streams_) writeEventMessage(stream);
  writeChunk();
  const std::uint64_t index_position = file_.size();
  scratch_.clear();
  for (std::size_t id = 0; id < streams_.size(); ++id)
    if (streams_[id].written) appendConnection(id, scratch_);
  for (const ChunkInfo& info : chunks_) {
    BagFieldsWriter header;
    header.op(BagOp::ChunkInfo)
        .number("ver", std::uint32_t{1})
        .number("chunk_pos", info.position)
        .time("start_time", info.start_ns)
        .time("end_time", info.end_ns)
        .number("count", info.connections);
    appendBagRecord(scratch_, header, info.counts);
  }
  file_.append(scratch_);
  writeHeader(index_position);
  file_.close();
  file_.rename();
}

std::unique_ptr<RecordingWriter> createRosbag(const std::filesystem::path& path, BagCompression compression) {
  return std::make_unique<RosbagWriter>(path, compression);
}

}  // namespace evical
