#include "core/pipeline/pass/session_time_range.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/time.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {

bool SessionTimeRange::holds(std::int64_t time_ns) const {
  if (!session_.time_range_s) return true;
  const double time_s = secondsSince(start_ns_, time_ns);
  return time_s >= (*session_.time_range_s)[0] && time_s <= (*session_.time_range_s)[1];
}

bool SessionTimeRange::isOver(const SensorPacket& packet) {
  if (!session_.time_range_s) return false;
  const auto follow = [&](const auto& items) {
    if (!items.empty()) latest_ns_ = std::max(latest_ns_, items.back().time_ns);
  };
  follow(packet.events);
  follow(packet.imu_samples);
  follow(packet.frames);
  follow(packet.points);
  constexpr double kMargin_s = 1.0;  // larger than the disorder of packets in files
  const auto behind = [&](const auto& items) {
    return !items.empty() &&
           secondsSince(start_ns_, items.front().time_ns) > (*session_.time_range_s)[1] + kMargin_s;
  };
  behind_[packet.sensor] =
      behind(packet.events) || behind(packet.imu_samples) || behind(packet.frames) || behind(packet.points);
  return std::ranges::all_of(behind_, [](bool each) { return each; });
}

void SessionTimeRange::checkBegin() const {
  if (!session_.time_range_s) return;
  const double end_s = secondsSince(start_ns_, latest_ns_), begin_s = session_.time_range_s->front();
  if (begin_s <= end_s) return;
  throw badInput(
      session_.recording.string(),
      fmt::format("lasts {:.1f} s, but {} begins at {:g} s", end_s, howTo(HowTo::LimitTime), begin_s),
      "Give a range within the recording, in seconds since its start");
}

}  // namespace evical
