#include "core/maintenance/stop_detection.h"

#include "core/numerics/angles.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr int kFewest = 4;  // samples in a window

double lowQuantile(std::vector<double> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 10);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

// What still windows are like in this log.
struct Stillness {
  double rate_variance = 0.0, force_variance = 0.0;

  bool of(const MeansWindow& window) const {
    return window.samples >= kFewest && window.rate_variance <= rate_variance &&
           window.force_variance <= force_variance;
  }
};

Stillness stillnessOf(std::span<const MeansWindow> windows, const MaintenanceOptions& options) {
  std::vector<double> rates, forces;
  for (const MeansWindow& window : windows) {
    if (window.samples < kFewest) continue;
    rates.push_back(window.rate_variance);
    forces.push_back(window.force_variance);
  }
  if (rates.empty()) return {};
  // Of quantised numbers a window may have no variance at all.
  constexpr double kLeast = 1e-10;
  const auto limit = [&](const std::vector<double>& variances, double most) {
    return std::min(options.stop_above_quietest * std::max(lowQuantile(variances), kLeast), most * most);
  };
  return {limit(rates, options.stop_rate_rad_s), limit(forces, options.stop_force_m_s2)};
}

struct RunMeans {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
  double count = 0.0;

  void add(const MeansWindow& window) {
    rate += (window.rate_rad_s - rate) / (count + 1.0);
    force += (window.force_m_s2 - force) / (count + 1.0);
    count += 1.0;
  }
  bool holds(const MeansWindow& window, double still_rate, double still_force) const {
    const double rate_sigma = std::sqrt(window.rate_variance / window.samples);
    const double force_sigma = std::sqrt(window.force_variance / window.samples);
    return count == 0.0 ||
           ((window.rate_rad_s - rate).cwiseAbs().maxCoeff() < still_rate + 5.0 * rate_sigma &&
            (window.force_m_s2 - force).cwiseAbs().maxCoeff() < still_force + 5.0 * force_sigma);
  }
};

// Even turning is smooth, too: a stop's rate is the bias, small and nearly the same in all.
void dropTurning(std::span<const MeansWindow> windows, double still_rate, std::vector<StopRange>& stops) {
  std::vector<Eigen::Vector3d> rates;
  for (const StopRange& stop : stops) {
    RunMeans means;
    for (std::size_t i = stop.first; i <= stop.last; ++i) means.add(windows[i]);
    rates.push_back(means.rate);
  }
  const auto slower = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.norm() < b.norm(); };
  const auto slowest = std::min_element(rates.begin(), rates.end(), slower);
  std::vector<StopRange> kept;
  for (std::size_t s = 0; s < stops.size(); ++s)
    if ((rates[s] - *slowest).cwiseAbs().maxCoeff() <= 2.0 * still_rate) kept.push_back(stops[s]);
  stops = kept;
}

}  // namespace

void WindowMeans::add(double time_s, const ImuSample& sample) {
  if (open_ && (time_s - current_.time_s >= kLength_s || time_s < current_.time_s)) close();
  if (!open_) {
    open_ = true;
    current_ = {};
    current_.time_s = time_s;
    rate_origin_ = sample.angular_rate_rad_s;
    force_origin_ = sample.specific_force_m_s2;
  }
  const Eigen::Vector3d rate = sample.angular_rate_rad_s - rate_origin_,
                        force = sample.specific_force_m_s2 - force_origin_;
  ++current_.samples;
  current_.rate_rad_s += rate;
  current_.force_m_s2 += force;
  current_.rate_variance += rate.squaredNorm();
  current_.force_variance += force.squaredNorm();
}

void WindowMeans::close() {
  open_ = false;
  const double n = current_.samples;
  current_.rate_rad_s /= n;
  current_.force_m_s2 /= n;
  const double freedom = 3.0 * std::max(n - 1.0, 1.0);
  current_.rate_variance = (current_.rate_variance - n * current_.rate_rad_s.squaredNorm()) / freedom;
  current_.force_variance = (current_.force_variance - n * current_.force_m_s2.squaredNorm()) / freedom;
  current_.rate_rad_s += rate_origin_;
  current_.force_m_s2 += force_origin_;
  windows_.push_back(current_);
}

void WindowMeans::finish() {
  if (open_) close();
}

std::vector<StopRange> findStops(std::span<const MeansWindow> windows, const MaintenanceOptions& options) {
  const Stillness still = stillnessOf(windows, options);
  const double still_rate = options.still_rate_deg_s * kRadPerDeg;
  std::vector<StopRange> stops;
  const auto fewest = static_cast<std::size_t>(std::ceil(options.shortest_stop_s / WindowMeans::kLength_s));
  for (std::size_t begin = 0; begin < windows.size();) {
    RunMeans means;
    std::size_t end = begin;
    for (; end < windows.size() && still.of(windows[end]); ++end) {
      if (!means.holds(windows[end], still_rate, options.still_force_m_s2)) break;
      if (end > begin &&
          windows[end].time_s - windows[end - 1].time_s > WindowMeans::kLength_s + options.gap_s)
        break;
      means.add(windows[end]);
    }
    if (end - begin >= fewest + 2) stops.push_back({begin + 1, end - 2});
    begin = std::max(end, begin + 1);
  }
  dropTurning(windows, still_rate, stops);
  return stops;
}

double rateScale(std::span<const MeansWindow> windows) {
  constexpr double kAlike = 0.15;
  constexpr double kFewest_rad = 0.3;  // that gravity turns in all, over still and slow moments
  double turned = 0.0, said = 0.0, changed = 0.0, way = 0.0;
  for (std::size_t i = 1; i + 1 < windows.size(); ++i) {
    const double span_s = windows[i + 1].time_s - windows[i - 1].time_s;
    if (span_s > 3.0 * WindowMeans::kLength_s || windows[i].samples < kFewest) continue;
    const Eigen::Vector3d change = windows[i + 1].force_m_s2 - windows[i - 1].force_m_s2;
    const Eigen::Vector3d expected = -span_s * windows[i].rate_rad_s.cross(windows[i].force_m_s2);
    turned += change.dot(expected);
    said += expected.squaredNorm();
    changed += change.squaredNorm();
    way += change.norm() / std::max(windows[i].force_m_s2.norm(), 1e-6);
  }
  // On rough ground forces change for other reasons.
  const bool alike = turned > kAlike * std::sqrt(said * changed);
  return way > kFewest_rad && said > 0.0 && alike ? turned / said : 0.0;
}

}  // namespace evical
