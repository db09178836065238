#include "tests/core/recording/bag_builder.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <stdexcept>

namespace evical::test {
namespace {

constexpr std::string_view kBagBuilderMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kBagHeaderSize = 4096;

std::string op(std::uint8_t code) {
  return field("op", bytesOf(code));
}

std::string packed(const std::string& compression, const std::string& plain) {
  if (compression == "lz4") {
    std::string result(LZ4F_compressFrameBound(plain.size(), nullptr), '\0');
    result.resize(LZ4F_compressFrame(result.data(), result.size(), plain.data(), plain.size(), nullptr));
    return result;
  }
  if (compression == "bz2") {
    std::string result(plain.size() + plain.size() / 50 + 1000, '\0');
    auto size = static_cast<unsigned>(result.size());
    const int status = BZ2_bzBuffToBuffCompress(result.data(), &size, const_cast<char*>(plain.data()),
                                                static_cast<unsigned>(plain.size()), 9, 0, 0);
    if (status != BZ_OK) throw std::runtime_error("bzip2 failed");
    result.resize(size);
    return result;
  }
  return plain;
}

std::string bagHeader(std::uint64_t index_position, std::size_t connections, std::size_t chunks) {
  const std::string header = op(3) + field("index_pos", bytesOf(index_position)) +
                             field("conn_count", bytesOf(static_cast<std::uint32_t>(connections))) +
                             field("chunk_count", bytesOf(static_cast<std::uint32_t>(chunks)));
  return std::string(kBagBuilderMagic) + sized(header) +
         sized(std::string(kBagHeaderSize - 8 - header.size(), ' '));
}

std::string messageHeader(std::int64_t stamp_ns) {
  return bytesOf(std::uint32_t{0}) + timeBytes(stamp_ns) + sized("camera");
}

std::string vectorBytes(const Eigen::Vector3d& vector) {
  return bytesOf(vector.x()) + bytesOf(vector.y()) + bytesOf(vector.z());
}

}  // namespace

std::string field(std::string_view name, std::string_view value) {
  return sized(std::string(name) + "=" + std::string(value));
}

std::string timeBytes(std::int64_t time_ns) {
  return bytesOf(static_cast<std::uint32_t>(time_ns / 1'000'000'000)) +
         bytesOf(static_cast<std::uint32_t>(time_ns % 1'000'000'000));
}

std::string sized(std::string_view content) {
  return bytesOf(static_cast<std::uint32_t>(content.size())) + std::string(content);
}

std::uint32_t BagBuilder::addConnection(const std::string& topic, const std::string& type,
                                        const std::string& md5, const std::string& definition) {
  const auto id = static_cast<std::uint32_t>(connections_.size());
  Connection connection;
  connection.header = op(7) + field("conn", bytesOf(id)) + field("topic", topic);
  connection.type = field("type", type) + field("md5sum", md5) + field("message_definition", definition);
  connection.data = field("topic", topic) + connection.type;
  connections_.push_back(connection);
  return id;
}

void BagBuilder::setPublisher(std::uint32_t id, const std::string& node) {
  connections_.at(id).data += field("callerid", node);
}

void BagBuilder::setTopicInData(std::uint32_t id, const std::optional<std::string>& topic) {
  Connection& connection = connections_.at(id);
  connection.data = (topic ? field("topic", *topic) : std::string()) + connection.type;
}

void BagBuilder::message(std::uint32_t id, std::int64_t record_time_ns, const std::string& content) {
  Connection& connection = connections_.at(id);
  if (!connection.written) record(connection.header, connection.data);
  connection.written = true;
  connection.index += timeBytes(record_time_ns) + bytesOf(static_cast<std::uint32_t>(chunk_.size()));
  connection.count += 1;
  record(op(2) + field("conn", bytesOf(id)) + field("time", timeBytes(record_time_ns)), content);
}

void BagBuilder::record(const std::string& header, const std::string& data) {
  chunk_ += sized(header) + sized(data);
}

void BagBuilder::endChunk() {
  if (chunk_.empty()) return;
  const std::size_t position = kBagBuilderMagic.size() + kBagHeaderSize + chunks_.size();
  chunk_positions_.push_back(position);
  chunks_ += sized(op(5) + field("compression", compression_) +
                   field("size", bytesOf(static_cast<std::uint32_t>(chunk_.size())))) +
             sized(packed(compression_, chunk_));
  std::string counts;
  std::uint32_t used = 0;
  for (std::uint32_t id = 0; id < connections_.size(); ++id) {
    Connection& connection = connections_[id];
    if (connection.count == 0) continue;
    chunks_ += sized(op(4) + field("ver", bytesOf(std::uint32_t{1})) + field("conn", bytesOf(id)) +
                     field("count", bytesOf(connection.count))) +
               sized(connection.index);
    counts += bytesOf(id) + bytesOf(connection.count);
    connection.index.clear();
    connection.count = 0;
    ++used;
  }
  infos_ += sized(op(6) + field("ver", bytesOf(std::uint32_t{1})) +
                  field("chunk_pos", bytesOf(static_cast<std::uint64_t>(position))) +
                  field("start_time", timeBytes(1)) + field("end_time", timeBytes(2)) +
                  field("count", bytesOf(used))) +
            sized(counts);
  chunk_.clear();
}

std::string BagBuilder::unfinished() {
  endChunk();
  return bagHeader(0, 0, 0) + chunks_;
}

std::string BagBuilder::finished() {
  endChunk();
  std::string index;
  std::size_t used = 0;
  for (const Connection& connection : connections_) {
    if (!connection.written) continue;
    index += sized(connection.header) + sized(connection.data);
    ++used;
  }
  const std::size_t index_position = kBagBuilderMagic.size() + kBagHeaderSize + chunks_.size();
  return bagHeader(index_position, used, chunk_positions_.size()) + chunks_ + index + infos_;
}

std::string eventMessage(std::int64_t stamp_ns, Resolution resolution_px, const std::vector<Event>& events) {
  std::string message = messageHeader(stamp_ns) +
                        bytesOf(static_cast<std::uint32_t>(resolution_px.height_px)) +
                        bytesOf(static_cast<std::uint32_t>(resolution_px.width_px)) +
                        bytesOf(static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events)
    message += bytesOf(event.x_px) + bytesOf(event.y_px) + timeBytes(event.time_ns) +
               bytesOf(static_cast<std::uint8_t>(event.brighter ? 1 : 0));
  return message;
}

std::string imuMessage(const ImuSample& sample) {
  const std::string covariance(9 * sizeof(double), '\0');
  return messageHeader(sample.time_ns) + std::string(4 * sizeof(double), '\0') + covariance +
         vectorBytes(sample.angular_rate_rad_s) + covariance + vectorBytes(sample.specific_force_m_s2) +
         covariance;
}

}  // namespace evical::test
