// Builds ROS 2 recordings byte by byte, without the product's code: CDR messages, MCAP files without chunks
// or summary, sqlite3 bags.
#pragma once

#include "core/data/recording.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace evical::test {

std::string cdrEvents(Resolution resolution_px, const std::vector<Event>& events, bool big_endian = false);
std::string cdrImu(const ImuSample& sample);

struct RosMessage {
  std::size_t topic = 0;
  std::int64_t time_ns = 0;
  std::string bytes;
};
struct RosTopic {
  std::string name, type;
  std::string encoding = "cdr";
};

std::string mcapRecord(std::uint8_t op, std::string_view content);
// Each message separately; if `chunk_messages` is not 0, that many per chunk. Without indexes.
std::string mcapFile(const std::vector<RosTopic>& topics, const std::vector<RosMessage>& messages,
                     std::size_t chunk_messages = 0);

void writeSqliteBag(const std::filesystem::path& path, const std::vector<RosTopic>& topics,
                    const std::vector<RosMessage>& messages, bool with_index = true);

}  // namespace evical::test
