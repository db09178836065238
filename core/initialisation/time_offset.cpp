#include "core/initialisation/time_offset.h"

#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace evical {
namespace {

constexpr double kGrid_s = 0.005;      // of the gyroscope's rates; a fraction of a hand's shortest period
constexpr double kLongestRatio = 1.5;  // of a pair's duration to the usual one

// The gyroscope's rate averaged over `duration_s`, on a grid of middles.
struct RateGrid {
  double begin_s;
  std::vector<double> rates_rad_s;
  double highest_rad_s = 0.0;

  RateGrid(const GyroRotation& gyro, double duration_s) : begin_s(gyro.begin_s() + 0.5 * duration_s) {
    const double half_s = 0.5 * duration_s;
    for (double time_s = begin_s; time_s + half_s <= gyro.end_s(); time_s += kGrid_s) {
      rates_rad_s.push_back(gyro.between(time_s - half_s, time_s + half_s).norm() / duration_s);
      highest_rad_s = std::max(highest_rad_s, rates_rad_s.back());
    }
  }
  std::optional<double> at(double time_s) const {
    const double position = (time_s - begin_s) / kGrid_s;
    if (position < 0.0) return std::nullopt;
    const auto k = static_cast<std::size_t>(position);
    if (k + 1 >= rates_rad_s.size()) return std::nullopt;
    const double part = position - static_cast<double>(k);
    return rates_rad_s[k] + part * (rates_rad_s[k + 1] - rates_rad_s[k]);
  }
};

struct Correlation {
  double value = -2.0;
  double significance = -1.0;
};

Correlation correlationAt(const std::vector<RatePair>& pairs, const RateGrid& grid, double offset_s,
                          double pairs_per_s, double least_overlap_s) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, syy = 0.0, sxy = 0.0;
  for (const RatePair& pair : pairs) {
    const std::optional<double> felt = grid.at(pair.middle_s + offset_s);
    if (!felt) continue;
    const double x = pair.rate_rad_s, y = *felt;
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    syy += y * y;
    sxy += x * y;
  }
  const double overlap_s = n / pairs_per_s;
  if (overlap_s < least_overlap_s) return {};
  const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n;
  if (vx <= 0.0 || vy <= 0.0) return {};
  const double value = (sxy - sx * sy / n) / std::sqrt(vx * vy);
  // Fisher's transform: its spread depends on the number of independent values, which is proportional to the
  // time.
  constexpr double kHighest = 0.999;
  return {value, std::atanh(std::clamp(value, -kHighest, kHighest)) * std::sqrt(overlap_s)};
}

TimeOffsetPeak peakAt(const std::vector<Correlation>& correlations, std::size_t i, double offset_s,
                      double step_s) {
  const Correlation& here = correlations[i];
  TimeOffsetPeak peak{offset_s, here.value, here.significance, step_s};
  if (i == 0 || i + 1 == correlations.size()) return peak;
  const double before = correlations[i - 1].value, after = correlations[i + 1].value;
  const double bend = before + after - 2.0 * here.value;
  if (before < -1.0 || after < -1.0 || bend >= 0.0) return peak;
  peak.time_offset_s += std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) * step_s;
  peak.width_s = step_s * std::sqrt(0.2 / -bend);
  return peak;
}

}  // namespace

std::vector<RatePair> ratePairs(const std::vector<CameraPose>& poses, double gap_s, double longest_s) {
  std::vector<RatePair> pairs;
  std::vector<double> durations;
  for (std::size_t k = 0, l = 0; k < poses.size(); ++k) {
    while (l < poses.size() && poses[l].time_s - poses[k].time_s < gap_s - 1e-6) ++l;
    if (l >= poses.size()) break;
    const double duration_s = poses[l].time_s - poses[k].time_s;
    if (duration_s > longest_s) continue;
    const double angle =
        rotationAngleBetween_rad(poses[k].world_from_camera.rotation, poses[l].world_from_camera.rotation);
    pairs.push_back({poses[k].time_s + 0.5 * duration_s, angle / duration_s, duration_s});
    durations.push_back(duration_s);
  }
  if (pairs.empty()) return pairs;
  const double longest_usual_s = kLongestRatio * medianOf(std::move(durations));
  std::erase_if(pairs, [&](const RatePair& pair) { return pair.duration_s > longest_usual_s; });
  return pairs;
}

std::vector<TimeOffsetPeak> correlateTimeOffset(const std::vector<CameraPose>& poses,
                                                const GyroRotation& gyro,
                                                const InitialisationOptions& options,
                                                const SensorPrior& prior) {
  constexpr double kStep_s = 0.01;
  std::vector<RatePair> pairs = ratePairs(poses, options.pair_gap_s, options.longest_pair_s);
  if (pairs.empty()) return {};
  double duration_s = 0.0;
  for (const RatePair& pair : pairs) duration_s += pair.duration_s;
  duration_s /= static_cast<double>(pairs.size());
  const RateGrid grid(gyro, duration_s);
  std::erase_if(pairs, [&](const RatePair& pair) {
    return pair.rate_rad_s > options.fastest_view_ratio * grid.highest_rad_s + 0.1;
  });
  if (pairs.size() < 5) return {};
  // Gaps count as overlap, since a board in every tenth window would otherwise need ten times the recording.
  const double pairs_per_s = static_cast<double>(pairs.size()) /
                             std::max(pairs.back().middle_s - pairs.front().middle_s, duration_s);
  const bool given = isGiven(prior.time_offset);
  const double centre_s = prior.time_offset ? prior.time_offset->value : 0.0;
  const int steps = given ? 0 : static_cast<int>(std::ceil(options.time_offset_search_s / kStep_s));
  std::vector<Correlation> correlations;
  correlations.reserve(static_cast<std::size_t>(2 * steps + 1));
  for (int k = -steps; k <= steps; ++k)
    correlations.push_back(
        correlationAt(pairs, grid, centre_s + k * kStep_s, pairs_per_s, options.least_overlap_s));
  std::vector<TimeOffsetPeak> peaks;
  for (std::size_t i = 0; i < correlations.size(); ++i) {
    const double here = correlations[i].significance;
    if (here < 0.0 && !(given && correlations[i].value >= -1.0)) continue;
    if (i > 0 && here < correlations[i - 1].significance) continue;
    if (i + 1 < correlations.size() && here <= correlations[i + 1].significance) continue;
    peaks.push_back(peakAt(correlations, i, centre_s + (static_cast<double>(i) - steps) * kStep_s, kStep_s));
  }
  std::sort(peaks.begin(), peaks.end(),
            [](const auto& a, const auto& b) { return a.significance > b.significance; });
  const auto most = static_cast<std::size_t>(options.most_time_offsets);
  if (peaks.size() > most) peaks.resize(most);
  return peaks;
}

}  // namespace evical
