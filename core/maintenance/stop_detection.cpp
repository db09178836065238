#include "core/maintenance/stop_detection.h"

#include "core/maintenance/maintenance_options.h"
#include "core/numerics/angles.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr int kFewest = 4;  // samples in a window

bool hasBoth(const MeansWindow& window) {
  return window.samples >= kFewest && window.forces >= kFewest;
}

// Averages over the windows within half a second, so that one disturbed quarter of a second does not end a
// stop. Without windows with too few samples, and those on the other side of a gap.
std::vector<double> smoothed(std::span<const MeansWindow> windows, double MeansWindow::*variance) {
  constexpr std::ptrdiff_t kBeside = 2;
  std::vector<double> means;
  const auto count = static_cast<std::ptrdiff_t>(windows.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(i - kBeside, 0),
                         end = std::min(i + kBeside + 1, count);
    double sum = 0.0;
    int used = 0;
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      const MeansWindow& window = windows[static_cast<std::size_t>(k)];
      const double apart_s = std::abs(window.time_s - windows[static_cast<std::size_t>(i)].time_s);
      if (!hasBoth(window) || apart_s > (kBeside + 1) * WindowMeans::kLength_s) continue;
      sum += window.*variance;
      ++used;
    }
    means.push_back(sum / std::max(used, 1));
  }
  return means;
}

// Uses only windows with enough samples.
double lowQuantile(std::span<const MeansWindow> windows, const std::vector<double>& variances) {
  std::vector<double> values;
  for (std::size_t i = 0; i < windows.size(); ++i)
    if (hasBoth(windows[i])) values.push_back(variances[i]);
  if (values.empty()) return 0.0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 10);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

// Finds the windows in which the IMU is at rest. The accelerometer decides, relative to the log's quietest
// tenth. A hand rotates an IMU ten times as much as a table does, so the gyroscope only has an absolute
// limit.
std::vector<bool> stillWindows(std::span<const MeansWindow> windows, double above_quietest,
                               const MaintenanceOptions& options) {
  // Quantised values may have zero variance in a window.
  constexpr double kMin = 1e-10;
  const std::vector<double> forces = smoothed(windows, &MeansWindow::force_variance),
                            rates = smoothed(windows, &MeansWindow::rate_variance);
  const double max_force = std::min(above_quietest * std::max(lowQuantile(windows, forces), kMin),
                                    options.stop_force_m_s2 * options.stop_force_m_s2);
  const double max_rate = options.stop_rate_rad_s * options.stop_rate_rad_s;
  std::vector<bool> still;
  for (std::size_t i = 0; i < windows.size(); ++i)
    still.push_back(hasBoth(windows[i]) && forces[i] <= max_force && rates[i] <= max_rate);
  return still;
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
    const double force_sigma = std::sqrt(window.force_variance / window.forces);
    return count == 0.0 ||
           ((window.rate_rad_s - rate).cwiseAbs().maxCoeff() < still_rate + 5.0 * rate_sigma &&
            (window.force_m_s2 - force).cwiseAbs().maxCoeff() < still_force + 5.0 * force_sigma);
  }
};

// Removes constant rotation, which has low variance, too: a stop's rate is the bias, small and nearly equal
// in all stops.
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
  if (measuresRate(sample)) {
    const Eigen::Vector3d rate = sample.angular_rate_rad_s - rate_origin_;
    ++current_.samples;
    current_.rate_rad_s += rate;
    current_.rate_variance += rate.squaredNorm();
  }
  if (measuresForce(sample)) {
    const Eigen::Vector3d force = sample.specific_force_m_s2 - force_origin_;
    ++current_.forces;
    current_.force_m_s2 += force;
    current_.force_variance += force.squaredNorm();
  }
}

void WindowMeans::close() {
  open_ = false;
  const auto toMean = [](double count, Eigen::Vector3d& sum, double& squares) {
    sum /= std::max(count, 1.0);
    squares = (squares - count * sum.squaredNorm()) / (3.0 * std::max(count - 1.0, 1.0));
  };
  toMean(current_.samples, current_.rate_rad_s, current_.rate_variance);
  toMean(current_.forces, current_.force_m_s2, current_.force_variance);
  current_.rate_rad_s += rate_origin_;
  current_.force_m_s2 += force_origin_;
  windows_.push_back(current_);
}

void WindowMeans::finish() {
  if (open_) close();
}

std::vector<StopRange> findStops(std::span<const MeansWindow> windows, double above_quietest,
                                 const MaintenanceOptions& options) {
  constexpr double kWithinStop = 4.0;  // relative to the allowed difference between stops: hands sway
  const std::vector<bool> still = stillWindows(windows, above_quietest, options);
  const double still_rate = options.still_rate_deg_s * kRadPerDeg;
  std::vector<StopRange> stops;
  const auto fewest = static_cast<std::size_t>(std::ceil(options.min_stop_s / WindowMeans::kLength_s));
  for (std::size_t begin = 0; begin < windows.size();) {
    RunMeans means;
    std::size_t end = begin;
    for (; end < windows.size() && still[end]; ++end) {
      if (!means.holds(windows[end], kWithinStop * still_rate, options.still_force_m_s2)) break;
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
  constexpr double kFewest_rad = 0.3;  // smallest total rotation of gravity, while still or slow
  double turned = 0.0, said = 0.0, changed = 0.0, way = 0.0;
  for (std::size_t i = 1; i + 1 < windows.size(); ++i) {
    const double span_s = windows[i + 1].time_s - windows[i - 1].time_s;
    if (span_s > 3.0 * WindowMeans::kLength_s || !hasBoth(windows[i])) continue;
    const Eigen::Vector3d change = windows[i + 1].force_m_s2 - windows[i - 1].force_m_s2;
    const Eigen::Vector3d expected = -span_s * windows[i].rate_rad_s.cross(windows[i].force_m_s2);
    turned += change.dot(expected);
    said += expected.squaredNorm();
    changed += change.squaredNorm();
    way += change.norm() / std::max(windows[i].force_m_s2.norm(), 1e-6);
  }
  // On rough ground, forces change for other reasons.
  const bool alike = turned > kAlike * std::sqrt(said * changed);
  return way > kFewest_rad && said > 0.0 && alike ? turned / said : 0.0;
}

}  // namespace evical
