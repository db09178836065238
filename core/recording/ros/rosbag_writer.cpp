#include "core/recording/ros/rosbag_writer.h"

#include "core/base/error.h"
#include "core/recording/ros/bag_records.h"
#include "core/recording/ros/ros_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace evical {
namespace {

constexpr std::int64_t kMessageSpan_ns = 10'000'000;
constexpr std::size_t kMessageEvents = 200'000;
constexpr std::size_t kChunkBytes = 768 * 1024;  // what rosbag record uses
constexpr std::size_t kBagHeaderBytes = 4096;    // of the whole record, by the format
constexpr std::int64_t kSecond_ns = 1'000'000'000;

template <class Number>
std::string bytesOf(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string bytesOfTime(std::int64_t time_ns) {
  // rosbag takes a record time of zero for "not set".
  const std::int64_t time = std::max<std::int64_t>(1, time_ns);
  return bytesOf(static_cast<std::uint32_t>(time / kSecond_ns)) +
         bytesOf(static_cast<std::uint32_t>(time % kSecond_ns));
}

std::string sized(std::string_view bytes) {
  std::string result = bytesOf(static_cast<std::uint32_t>(bytes.size()));
  return result.append(bytes);
}

std::string field(std::string_view name, std::string_view value) {
  return sized(std::string(name).append("=").append(value));
}

std::string opField(rosbag::Op op) {
  return field("op", bytesOf(op));
}

}  // namespace

RosbagWriter::RosbagWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
                           bool lz4)
    : path_(path.string()), file_(path), lz4_(lz4) {
  for (const StreamInfo& stream : streams) {
    const bool events = stream.type == StreamType::Events;
    if (!events && stream.type != StreamType::Imu) {
      throw badInput(path_, fmt::format("stream {} holds neither events nor IMU samples", stream.name));
    }
    if (events && !stream.resolution_px.known()) {
      throw badInput(path_, fmt::format("the resolution of stream {} is missing", stream.name));
    }
    streams_.push_back({stream, 0, false, {}, {}});
  }
  file_.append(rosbag::kMagic);
  file_.append(bagHeader(0));
}

void RosbagWriter::write(std::size_t stream, EventSpan events) {
  std::vector<Event>& gathered = checkedStream(stream, StreamType::Events).events;
  for (const Event& event : events) {
    requireTime(event.time_ns);
    // A step back starts a message too: within one, readers sort.
    const bool full = !gathered.empty() && (event.time_ns < gathered.back().time_ns ||
                                            event.time_ns - gathered.front().time_ns >= kMessageSpan_ns ||
                                            gathered.size() >= kMessageEvents);
    if (full) flushEvents(stream);
    gathered.push_back(event);
  }
}

void RosbagWriter::write(std::size_t stream, std::span<const ImuSample> samples) {
  Stream& target = checkedStream(stream, StreamType::Imu);
  for (const ImuSample& sample : samples) {
    requireTime(sample.time_ns);
    message_.clear();
    ros::encodeImu(sample, target.sequence++, message_);
    appendMessage(stream, sample.time_ns);
  }
}

void RosbagWriter::finish() {
  for (std::size_t i = 0; i < streams_.size(); ++i) flushEvents(i);
  flushChunk();
  const std::uint64_t index_position = file_.size();
  for (std::size_t i = 0; i < streams_.size(); ++i) file_.append(connectionRecord(i));
  for (const ChunkInfo& chunk : chunks_) {
    file_.append(
        sized(opField(rosbag::Op::ChunkInfo) + field("ver", bytesOf(std::uint32_t{1})) +
              field("chunk_pos", bytesOf(chunk.position)) + field("start_time", bytesOfTime(chunk.first_ns)) +
              field("end_time", bytesOfTime(chunk.last_ns)) + field("count", bytesOf(chunk.connections))));
    file_.append(sized(chunk.counts));
  }
  file_.overwrite(rosbag::kMagic.size(), bagHeader(index_position));
  file_.finish();
}

void RosbagWriter::flushEvents(std::size_t stream) {
  Stream& source = streams_[stream];
  if (source.events.empty()) return;
  message_.clear();
  ros::encodeEventArray(source.events, source.sequence++, source.info.resolution_px, message_);
  appendMessage(stream, source.events.back().time_ns);
  source.events.clear();
}

void RosbagWriter::appendMessage(std::size_t stream, std::int64_t time_ns) {
  Stream& source = streams_[stream];
  if (!source.announced) chunk_ += connectionRecord(stream);
  source.announced = true;
  source.index.push_back({time_ns, static_cast<std::uint32_t>(chunk_.size())});
  chunk_ += sized(opField(rosbag::Op::Message) + field("conn", bytesOf(static_cast<std::uint32_t>(stream))) +
                  field("time", bytesOfTime(time_ns)));
  chunk_ += bytesOf(static_cast<std::uint32_t>(message_.size()));
  chunk_ += message_;
  if (chunk_.size() >= kChunkBytes) flushChunk();
}

void RosbagWriter::flushChunk() {
  if (chunk_.empty()) return;
  ChunkInfo chunk{file_.size(), std::numeric_limits<std::int64_t>::max(), 0, {}, 0};
  if (lz4_) rosbag::compressLz4(chunk_, compressed_);
  const std::string& data = lz4_ ? compressed_ : chunk_;
  file_.append(sized(opField(rosbag::Op::Chunk) + field("compression", lz4_ ? "lz4" : "none") +
                     field("size", bytesOf(static_cast<std::uint32_t>(chunk_.size())))));
  file_.append(bytesOf(static_cast<std::uint32_t>(data.size())));
  file_.append(data);
  appendIndex(chunk);
  chunks_.push_back(std::move(chunk));
  chunk_.clear();
}

void RosbagWriter::appendIndex(ChunkInfo& chunk) {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    std::vector<IndexEntry>& index = streams_[i].index;
    if (index.empty()) continue;
    const std::string connection = bytesOf(static_cast<std::uint32_t>(i));
    const std::string count = bytesOf(static_cast<std::uint32_t>(index.size()));
    std::string entries;
    for (const IndexEntry& entry : index) {
      chunk.first_ns = std::min(chunk.first_ns, entry.time_ns);
      chunk.last_ns = std::max(chunk.last_ns, entry.time_ns);
      entries += bytesOfTime(entry.time_ns) + bytesOf(entry.offset);
    }
    file_.append(sized(opField(rosbag::Op::IndexData) + field("ver", bytesOf(std::uint32_t{1})) +
                       field("conn", connection) + field("count", count)));
    file_.append(sized(entries));
    chunk.counts += connection + count;
    ++chunk.connections;
    index.clear();
  }
}

std::string RosbagWriter::bagHeader(std::uint64_t index_position) const {
  std::string record = sized(opField(rosbag::Op::BagHeader) + field("index_pos", bytesOf(index_position)) +
                             field("conn_count", bytesOf(static_cast<std::uint32_t>(streams_.size()))) +
                             field("chunk_count", bytesOf(static_cast<std::uint32_t>(chunks_.size()))));
  return record + sized(std::string(kBagHeaderBytes - record.size() - 4, ' '));
}

std::string RosbagWriter::connectionRecord(std::size_t stream) const {
  const StreamInfo& info = streams_[stream].info;
  const ros::MessageType& type = info.type == StreamType::Events ? ros::eventArrayType() : ros::imuType();
  return sized(opField(rosbag::Op::Connection) + field("conn", bytesOf(static_cast<std::uint32_t>(stream))) +
               field("topic", info.name)) +
         sized(field("topic", info.name) + field("type", type.name) + field("md5sum", type.md5) +
               field("message_definition", type.definition));
}

void RosbagWriter::requireTime(std::int64_t time_ns) const {
  if (time_ns >= 0 && time_ns < (kSecond_ns << 32)) return;
  throw calibrationFailed(path_, fmt::format("a bag cannot hold the time {} ns", time_ns),
                          "Bags hold times from 0 to 2^32 s.");
}

RosbagWriter::Stream& RosbagWriter::checkedStream(std::size_t stream, StreamType type) {
  Stream& checked = streams_.at(stream);
  if (checked.info.type == type) return checked;
  throw calibrationFailed(path_,
                          fmt::format("stream {} was given samples of another type", checked.info.name));
}

std::unique_ptr<RecordingWriter> createBag(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams, bool lz4) {
  return std::make_unique<RosbagWriter>(path, streams, lz4);
}

}  // namespace evical
