#include "core/recording/aedat/device_names.h"

#include <algorithm>

namespace evical::aedat {
namespace {

constexpr const char* kNobody = "Evical";

std::string sourceOf(const StreamInfo& stream) {
  if (!stream.source.empty()) return stream.source;
  const std::size_t begin = stream.name.starts_with('/') ? 1 : 0, end = stream.name.rfind('/');
  return end == std::string::npos || end <= begin ? std::string() : stream.name.substr(begin, end - begin);
}

// Our reader puts a source before names that are not unique.
std::string ownName(const StreamInfo& stream) {
  const std::string prefix = stream.source + "/";
  return !stream.source.empty() && stream.name.starts_with(prefix) ? stream.name.substr(prefix.size())
                                                                   : stream.name;
}

}  // namespace

std::vector<DeviceName> deviceNames(const std::vector<StreamInfo>& streams) {
  std::vector<DeviceName> names;
  for (const StreamInfo& stream : streams) names.push_back({sourceOf(stream), ownName(stream)});
  const auto is_camera = [](const StreamInfo& stream) { return stream.type == StreamType::Events; };
  const auto camera = std::find_if(streams.begin(), streams.end(), is_camera);
  const bool only = std::count_if(streams.begin(), streams.end(), is_camera) == 1;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (only && streams[i].source.empty())
      names[i].source = names[static_cast<std::size_t>(camera - streams.begin())].source;
    if (names[i].source.empty()) names[i].source = kNobody;
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    std::size_t same = 0;
    for (std::size_t j = 0; j < streams.size(); ++j)
      same += streams[j].type == streams[i].type && names[j].source == names[i].source;
    if (same == 1) names[i].output = is_camera(streams[i]) ? "events" : "imu";
  }
  return names;
}

}  // namespace evical::aedat
