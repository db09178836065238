#include "core/egomotion/alignment_start.h"

#include "core/geometry/best_rotation.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kStep_s = 0.005;
constexpr std::size_t kMostPeaks = 4;

struct Correlation {
  double offset_s = 0.0, value = -1.0;
};

// Correlation of the magnitudes of both rates, over the windows that the gyroscope covers at this offset.
Correlation correlationAt(double offset_s, const std::vector<const WindowMotion*>& windows,
                          const SummedRates& rates, const AlignmentState& start,
                          const Eigen::Matrix3d& imu_from_measured) {
  constexpr double kLeastShare = 0.5;
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (const WindowMotion* window : windows) {
    if (!rates.covers(window->begin_s + offset_s, window->end_s + offset_s)) continue;
    const Eigen::Vector3d mean = rates.mean_rad_s(window->begin_s + offset_s, window->end_s + offset_s);
    const double camera = window->rate_rad_s.norm(),
                 imu = (imu_from_measured * (mean - start.bias_rad_s)).norm();
    n += 1.0;
    a += camera;
    b += imu;
    aa += camera * camera;
    bb += imu * imu;
    ab += camera * imu;
  }
  if (n < kLeastShare * static_cast<double>(windows.size()) || n < 3.0) return {offset_s, -1.0};
  const double variance = (aa - a * a / n) * (bb - b * b / n);
  return {offset_s, variance > 0.0 ? (ab - a * b / n) / std::sqrt(variance) : -1.0};
}

Eigen::Matrix3d rotationOf(const std::vector<const WindowMotion*>& windows, const AlignmentFit& fit,
                           const SummedRates& rates, const AlignmentState& state) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const WindowMotion* window : windows) {
    if (!rates.covers(window->begin_s + state.time_offset_s, window->end_s + state.time_offset_s)) continue;
    const Eigen::Vector3d imu = fit.imuRate_rad_s(*window, state);
    const double size = std::max(imu.norm() * window->rate_rad_s.norm(), 1e-6);
    sum += imu * window->rate_rad_s.transpose() / std::sqrt(size);
  }
  return bestRotation(sum).matrix;
}

}  // namespace

std::vector<AlignmentState> alignmentStarts(const std::vector<const WindowMotion*>& windows,
                                            const AlignmentFit& fit, const SummedRates& rates,
                                            const AlignmentState& start, double search_s) {
  std::vector<AlignmentState> starts = {start};
  std::vector<Correlation> all, peaks;
  const int steps = static_cast<int>(std::floor(search_s / kStep_s));
  for (int k = -steps; k <= steps; ++k)
    all.push_back(
        correlationAt(start.time_offset_s + k * kStep_s, windows, rates, start, fit.imuFromMeasured()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool above_left = k == 0 || all[k].value >= all[k - 1].value;
    const bool above_right = k + 1 == all.size() || all[k].value > all[k + 1].value;
    if (above_left && above_right && all[k].value > 0.0) peaks.push_back(all[k]);
  }
  std::sort(peaks.begin(), peaks.end(),
            [](const Correlation& a, const Correlation& b) { return a.value > b.value; });
  peaks.resize(std::min(peaks.size(), kMostPeaks));
  for (const Correlation& peak : peaks) {
    AlignmentState state = start;
    state.time_offset_s = peak.offset_s;
    state.imu_from_camera = rotationOf(windows, fit, rates, state);
    starts.push_back(state);
  }
  return starts;
}

}  // namespace evical
