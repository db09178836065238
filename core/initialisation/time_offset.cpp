#include "core/initialisation/time_offset.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kStep_s = 0.005;
constexpr double kLeastOverlap = 0.4;  // of the pairs
constexpr std::size_t kMostPeaks = 5;

struct RatePair {
  double from_s, to_s, rate_rad_s;
};

std::vector<RatePair> ratePairs(const std::vector<CameraPose>& poses, double longest_pair_s) {
  constexpr double kShortest_s = 0.03;  // below it, noise of the poses outweighs the motion
  std::vector<RatePair> pairs;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    std::size_t l = k + 1;
    while (l < poses.size() && poses[l].time_s - poses[k].time_s < kShortest_s) ++l;
    if (l >= poses.size() || poses[l].time_s - poses[k].time_s > longest_pair_s) continue;
    const double angle =
        rotationAngleBetween_rad(poses[k].world_from_camera.rotation, poses[l].world_from_camera.rotation);
    pairs.push_back({poses[k].time_s, poses[l].time_s, angle / (poses[l].time_s - poses[k].time_s)});
  }
  return pairs;
}

double correlationAt(const std::vector<RatePair>& pairs, const GyroRotation& gyro, double offset_s) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, syy = 0.0, sxy = 0.0;
  for (const RatePair& pair : pairs) {
    if (!gyro.covers(pair.from_s + offset_s, pair.to_s + offset_s)) continue;
    const double x = pair.rate_rad_s;
    const double y =
        gyro.between(pair.from_s + offset_s, pair.to_s + offset_s).norm() / (pair.to_s - pair.from_s);
    // A single wild view must not decide.
    if (x > 50.0) continue;
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    syy += y * y;
    sxy += x * y;
  }
  if (n < kLeastOverlap * static_cast<double>(pairs.size()) || n < 5.0) return -2.0;
  const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n;
  return vx <= 0.0 || vy <= 0.0 ? -2.0 : (sxy - sx * sy / n) / std::sqrt(vx * vy);
}

}  // namespace

std::vector<TimeOffsetPeak> correlateTimeOffset(const std::vector<CameraPose>& poses,
                                                const GyroRotation& gyro, double search_s,
                                                double longest_pair_s) {
  const std::vector<RatePair> pairs = ratePairs(poses, longest_pair_s);
  const int steps = static_cast<int>(std::ceil(search_s / kStep_s));
  std::vector<double> correlation;
  for (int k = -steps; k <= steps; ++k) correlation.push_back(correlationAt(pairs, gyro, k * kStep_s));
  std::vector<TimeOffsetPeak> peaks;
  for (std::size_t i = 0; i < correlation.size(); ++i) {
    const double here = correlation[i];
    const double before = i > 0 ? correlation[i - 1] : -2.0,
                 after = i + 1 < correlation.size() ? correlation[i + 1] : -2.0;
    if (here < -1.0 || here < before || here <= after) continue;
    double shift = 0.0;
    if (before > -1.0 && after > -1.0 && before + after - 2.0 * here < 0.0) {
      shift = 0.5 * (before - after) / (before + after - 2.0 * here);
    }
    peaks.push_back({(static_cast<double>(i) - steps + shift) * kStep_s, here});
  }
  std::sort(peaks.begin(), peaks.end(),
            [](const auto& a, const auto& b) { return a.correlation > b.correlation; });
  if (peaks.size() > kMostPeaks) peaks.resize(kMostPeaks);
  return peaks;
}

}  // namespace evical
