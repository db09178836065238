#include "core/recording/ros/rosbag_writer.h"

#include "core/base/time.h"
#include "core/recording/recording_writer.h"
#include "core/recording/ros/bag_records.h"
#include "core/recording/ros/message_cursor.h"
#include "core/recording/ros/message_types.h"

#include <algorithm>
#include <limits>

namespace evical {
namespace {

using ros::sized;

constexpr std::size_t kChunkBytes = 768 * 1024;  // as rosbag record
constexpr std::size_t kBagHeaderBytes = 4096;    // size of the entire record, by the format
constexpr std::int64_t kBagSecondsEnd = std::int64_t{1} << 32;

std::string bytesOfTime(std::int64_t time_ns) {
  // rosbag takes a record time of zero for "not set".
  const std::int64_t time = std::max<std::int64_t>(1, time_ns);
  return numberBytes(static_cast<std::uint32_t>(time / kSecond_ns)) +
         numberBytes(static_cast<std::uint32_t>(time % kSecond_ns));
}

std::string field(std::string_view name, std::string_view value) {
  return sized(std::string(name).append("=").append(value));
}

std::string opField(rosbag::Op op) {
  return field("op", numberBytes(op));
}

}  // namespace

RosbagWriter::RosbagWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
                           bool lz4)
    : RosWriter(path, streams, ros::Serialization::Ros1, kBagSecondsEnd),
      file_(path),
      lz4_(lz4),
      connections_(streams.size()) {
  file_.append(rosbag::kMagic);
  file_.append(bagHeader(0));
}

void RosbagWriter::finish() {
  flushEvents();
  flushChunk();
  const std::uint64_t index_position = file_.size();
  for (std::size_t i = 0; i < streamCount(); ++i) file_.append(connectionRecord(i));
  for (const ChunkInfo& chunk : chunks_) {
    file_.append(sized(
        opField(rosbag::Op::ChunkInfo) + field("ver", numberBytes(std::uint32_t{1})) +
        field("chunk_pos", numberBytes(chunk.position)) + field("start_time", bytesOfTime(chunk.first_ns)) +
        field("end_time", bytesOfTime(chunk.last_ns)) + field("count", numberBytes(chunk.connections))));
    file_.append(sized(chunk.counts));
  }
  file_.overwrite(rosbag::kMagic.size(), bagHeader(index_position));
  file_.finish();
}

void RosbagWriter::flush() {
  flushEvents();
  flushChunk();
  file_.publish();
}

// All streams before the first message, so that readers know them; the type of frames follows from the first
// one.
void RosbagWriter::announce(std::size_t stream) {
  if (connections_[stream].announced) return;
  for (std::size_t i = 0; i < streamCount(); ++i) {
    if (connections_[i].announced || (i != stream && info(i).type == StreamType::Frames)) continue;
    connections_[i].announced = true;
    chunk_ += connectionRecord(i);
  }
}

void RosbagWriter::appendMessage(std::size_t stream, std::uint32_t /*sequence*/, std::int64_t time_ns,
                                 std::string_view message) {
  announce(stream);
  Connection& connection = connections_[stream];
  connection.index.push_back({time_ns, static_cast<std::uint32_t>(chunk_.size())});
  chunk_ +=
      sized(opField(rosbag::Op::Message) + field("conn", numberBytes(static_cast<std::uint32_t>(stream))) +
            field("time", bytesOfTime(time_ns)));
  chunk_ += numberBytes(static_cast<std::uint32_t>(message.size()));
  chunk_ += message;
  if (chunk_.size() >= kChunkBytes) flushChunk();
}

void RosbagWriter::flushChunk() {
  if (chunk_.empty()) return;
  ChunkInfo chunk{file_.size(), std::numeric_limits<std::int64_t>::max(), 0, {}, 0};
  if (lz4_) ros::packLz4(chunk_, compressed_);
  const std::string& data = lz4_ ? compressed_ : chunk_;
  file_.append(sized(opField(rosbag::Op::Chunk) + field("compression", lz4_ ? "lz4" : "none") +
                     field("size", numberBytes(static_cast<std::uint32_t>(chunk_.size())))));
  file_.append(numberBytes(static_cast<std::uint32_t>(data.size())));
  file_.append(data);
  appendIndex(chunk);
  chunks_.push_back(std::move(chunk));
  chunk_.clear();
}

void RosbagWriter::appendIndex(ChunkInfo& chunk) {
  for (std::size_t i = 0; i < streamCount(); ++i) {
    std::vector<IndexEntry>& index = connections_[i].index;
    if (index.empty()) continue;
    const std::string connection = numberBytes(static_cast<std::uint32_t>(i));
    const std::string count = numberBytes(static_cast<std::uint32_t>(index.size()));
    std::string entries;
    for (const IndexEntry& entry : index) {
      chunk.first_ns = std::min(chunk.first_ns, entry.time_ns);
      chunk.last_ns = std::max(chunk.last_ns, entry.time_ns);
      entries += bytesOfTime(entry.time_ns) + numberBytes(entry.offset);
    }
    file_.append(sized(opField(rosbag::Op::IndexData) + field("ver", numberBytes(std::uint32_t{1})) +
                       field("conn", connection) + field("count", count)));
    file_.append(sized(entries));
    chunk.counts += connection + count;
    ++chunk.connections;
    index.clear();
  }
}

std::string RosbagWriter::bagHeader(std::uint64_t index_position) const {
  std::string record =
      sized(opField(rosbag::Op::BagHeader) + field("index_pos", numberBytes(index_position)) +
            field("conn_count", numberBytes(static_cast<std::uint32_t>(streamCount()))) +
            field("chunk_count", numberBytes(static_cast<std::uint32_t>(chunks_.size()))));
  return record + sized(std::string(kBagHeaderBytes - record.size() - 4, ' '));
}

std::string RosbagWriter::connectionRecord(std::size_t stream) const {
  const ros::MessageType& type = messageType(stream);
  return sized(opField(rosbag::Op::Connection) +
               field("conn", numberBytes(static_cast<std::uint32_t>(stream))) +
               field("topic", info(stream).name)) +
         sized(field("topic", info(stream).name) + field("type", type.name) + field("md5sum", type.md5) +
               field("message_definition", type.definition));
}

std::unique_ptr<RecordingWriter> createBag(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams, bool lz4) {
  return std::make_unique<RosbagWriter>(path, streams, lz4);
}

}  // namespace evical
