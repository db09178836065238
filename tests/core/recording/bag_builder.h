// Builds ROS 1 bags byte by byte, without the product's code, including bags that no writer produces.
#pragma once

#include "core/data/recording.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::test {

inline constexpr const char* kEventArrayMd5 = "5e8beee5a6c107e504c2e78903c224b8";
inline constexpr const char* kImuMd5 = "6a62c6daae103f4ff57a132d6f95cec2";

class BagBuilder {
 public:
  explicit BagBuilder(std::string compression = "none") : compression_(std::move(compression)) {}

  std::uint32_t addConnection(const std::string& topic, const std::string& type, const std::string& md5,
                              const std::string& definition = {});
  std::uint32_t addEvents(const std::string& topic) {
    return addConnection(topic, "dvs_msgs/EventArray", kEventArrayMd5);
  }
  // The topic in the connection's data, which the record's header also has: librosbag's Bag::write omits it,
  // and a publisher may use another name.
  void setTopicInData(std::uint32_t connection, const std::optional<std::string>& topic);
  void setPublisher(std::uint32_t connection, const std::string& node);  // as rosbag record does
  std::uint32_t addImu(const std::string& topic) { return addConnection(topic, "sensor_msgs/Imu", kImuMd5); }

  void message(std::uint32_t connection, std::int64_t record_time_ns, const std::string& content);
  void record(const std::string& header, const std::string& data);  // unchanged, into the chunk
  void endChunk();

  // Leaves the bag like a recorder that was killed: without an index, which the bag header states.
  std::string unfinished();
  std::string finished();

  const std::vector<std::size_t>& chunkPositions() const { return chunk_positions_; }  // once ended

 private:
  struct Connection {
    std::string header, data, type;  // the type's fields are the end of the data
    bool written = false;
    std::string index;  // of this chunk
    std::uint32_t count = 0;
  };
  std::string compression_;
  std::vector<Connection> connections_;
  std::string chunk_, chunks_, infos_;
  std::vector<std::size_t> chunk_positions_;
};

std::string field(std::string_view name, std::string_view value);
template <class Number>
std::string bytesOf(Number value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}
std::string timeBytes(std::int64_t time_ns);
std::string sized(std::string_view content);

std::string eventMessage(std::int64_t stamp_ns, Resolution resolution_px, const std::vector<Event>& events);
std::string imuMessage(const ImuSample& sample);

}  // namespace evical::test
