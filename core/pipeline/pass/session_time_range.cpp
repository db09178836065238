#include "core/pipeline/pass/session_time_range.h"

#include "core/base/time.h"

#include <algorithm>

namespace evical {

bool SessionTimeRange::holds(std::int64_t time_ns) const {
  if (!session_.time_range_s) return true;
  const double time_s = secondsSince(start_ns_, time_ns);
  return time_s >= (*session_.time_range_s)[0] && time_s <= (*session_.time_range_s)[1];
}

bool SessionTimeRange::isOver(const SensorPacket& packet) {
  if (!session_.time_range_s) return false;
  constexpr double kMargin_s = 1.0;  // larger than the disorder of packets in files
  const auto behind = [&](const auto& items) {
    return !items.empty() &&
           secondsSince(start_ns_, items.front().time_ns) > (*session_.time_range_s)[1] + kMargin_s;
  };
  behind_[packet.sensor] =
      behind(packet.events) || behind(packet.imu_samples) || behind(packet.frames) || behind(packet.points);
  return std::ranges::all_of(behind_, [](bool each) { return each; });
}

}  // namespace evical
