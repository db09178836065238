#include "core/recording/ros/host_clock.h"

#include <algorithm>

namespace evical::ros {
namespace {

constexpr std::int64_t kSpan_ns = 3'000'000'000;
constexpr std::size_t kFewestForDrift = 5;  // spans; a drift of 20 ppm is then 0.3 ms, the jitter of delays
constexpr double kNs_s = 1e-9;

}  // namespace

void HostClock::add(std::int64_t sensor_ns, std::int64_t host_ns) {
  const Earliest candidate{sensor_ns, host_ns - sensor_ns};
  const auto [found, is_new] = earliest_.try_emplace(sensor_ns / kSpan_ns, candidate);
  if (!is_new && candidate.offset_ns < found->second.offset_ns) found->second = candidate;
}

std::optional<HostClockOffset> HostClock::offset() const {
  if (earliest_.empty()) return std::nullopt;
  const auto lower = [](const auto& a, const auto& b) { return a.second.offset_ns < b.second.offset_ns; };
  const std::int64_t least_ns = std::min_element(earliest_.begin(), earliest_.end(), lower)->second.offset_ns;
  if (earliest_.size() < kFewestForDrift) return HostClockOffset{kNs_s * static_cast<double>(least_ns), {}};
  // Least-squares line, with numbers small enough for doubles.
  const std::int64_t first_ns = earliest_.begin()->second.sensor_ns;
  double mean_t = 0.0, mean_o = 0.0, tt = 0.0, to = 0.0;
  const auto count = static_cast<double>(earliest_.size());
  const auto seconds = [&](const Earliest& e) { return kNs_s * static_cast<double>(e.sensor_ns - first_ns); };
  const auto beyond = [&](const Earliest& e) { return kNs_s * static_cast<double>(e.offset_ns - least_ns); };
  for (const auto& [span, earliest] : earliest_) {
    mean_t += seconds(earliest) / count;
    mean_o += beyond(earliest) / count;
  }
  for (const auto& [span, earliest] : earliest_) {
    tt += (seconds(earliest) - mean_t) * (seconds(earliest) - mean_t);
    to += (seconds(earliest) - mean_t) * (beyond(earliest) - mean_o);
  }
  const double middle_s = 0.5 * seconds(earliest_.rbegin()->second);
  const double slope = to / tt;
  return HostClockOffset{kNs_s * static_cast<double>(least_ns) + mean_o + slope * (middle_s - mean_t),
                         1e6 * slope};
}

}  // namespace evical::ros
