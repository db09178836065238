#include "core/initialisation/time_offset.h"

#include "core/numerics/robust.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
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
                          double pairs_per_s, double min_overlap_s) {
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
  if (overlap_s < min_overlap_s) return {};
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
  std::vector<RatePair> pairs = ratePairs(poses, options.pair_gap_s, options.max_pair_s);
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
        correlationAt(pairs, grid, centre_s + k * kStep_s, pairs_per_s, options.min_overlap_s));
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
  const auto most = static_cast<std::size_t>(options.max_time_offsets);
  if (peaks.size() > most) peaks.resize(most);
  return peaks;
}

namespace {

constexpr double kPart_s = 1.5;           // some oscillations of a hand
constexpr std::size_t kPairsOfPart = 30;  // hardly more are independent
constexpr double kPartGrid_s = 0.01, kReach_s = 0.3;

class Part {
 public:
  Part(std::vector<RotationPair> pairs, const GyroRotation& gyro, const RelativeRotation& whole)
      : pairs_(std::move(pairs)), gyro_(gyro), whole_(whole) {}

  std::optional<OffsetPart> offset() const {
    double best_s = whole_.time_offset_s, least = std::numeric_limits<double>::infinity();
    for (double shift_s = -kReach_s; shift_s <= kReach_s; shift_s += kPartGrid_s) {
      const double cost = medianError_rad(whole_.time_offset_s + shift_s);
      if (cost >= least) continue;
      least = cost;
      best_s = whole_.time_offset_s + shift_s;
    }
    OffsetPart part{pairs_.front().from_s, pairs_.back().to_s, best_s, 0.0};
    constexpr int kSteps = 6;
    for (int k = 0; k < kSteps; ++k)
      if (!refine(part)) return std::nullopt;
    return part;
  }

 private:
  Eigen::Vector3d error_rad(const RotationPair& pair, double offset_s) const {
    return gyro_.between(pair.from_s + offset_s, pair.to_s + offset_s) -
           whole_.reference_from_sensor * pair.seen_rad -
           whole_.gyroscope_bias_rad_s * (pair.to_s - pair.from_s);
  }
  double medianError_rad(double offset_s) const {
    std::vector<double> errors;
    errors.reserve(pairs_.size());
    for (const RotationPair& pair : pairs_) errors.push_back(error_rad(pair, offset_s).norm());
    return medianOf(std::move(errors));
  }
  // One Gauss-Newton step with Cauchy weights; false if nothing is determined.
  bool refine(OffsetPart& part) const {
    constexpr double kDelta_s = 1e-3;
    const double scale_rad = std::max(medianError_rad(part.time_offset_s), 1e-6);
    double matrix = 0.0, vector = 0.0;
    for (const RotationPair& pair : pairs_) {
      const Eigen::Vector3d error = error_rad(pair, part.time_offset_s);
      const Eigen::Vector3d slope =
          (error_rad(pair, part.time_offset_s + kDelta_s) - error_rad(pair, part.time_offset_s - kDelta_s)) /
          (2.0 * kDelta_s);
      const double weight = cauchyWeight(error.squaredNorm() / (scale_rad * scale_rad));
      matrix += weight * slope.squaredNorm();
      vector -= weight * slope.dot(error);
    }
    if (!(matrix > 0.0)) return false;
    part.time_offset_s += std::clamp(vector / matrix, -kPartGrid_s, kPartGrid_s);
    part.time_offset_std_s = scale_rad / std::sqrt(matrix);
    return true;
  }

  std::vector<RotationPair> pairs_;
  const GyroRotation& gyro_;
  const RelativeRotation& whole_;
};

std::vector<RotationPair> thinned(const std::vector<RotationPair>& pairs) {
  std::vector<RotationPair> few;
  const double stride = std::max(1.0, static_cast<double>(pairs.size()) / kPairsOfPart);
  for (double place = 0.0; place < static_cast<double>(pairs.size()); place += stride)
    few.push_back(pairs[static_cast<std::size_t>(place)]);
  return few;
}

// Weighted mean of parts, and their normalised residuals. Squares are limited, since a part may have a large
// error.
struct PartLevel {
  double offset_s = 0.0, std_s = 0.0, chi2 = 0.0;
};

PartLevel levelOf(const std::vector<OffsetPart>& parts, std::size_t begin, std::size_t end) {
  constexpr double kMinSigma_s = 2e-4, kMaxSigmas = 6.0;
  std::vector<double> offsets;
  for (std::size_t k = begin; k < end; ++k) offsets.push_back(parts[k].time_offset_s);
  const double centre_s = medianOf(std::move(offsets));
  double weights = 0.0, sum = 0.0;
  PartLevel level;
  for (std::size_t k = begin; k < end; ++k) {
    const double sigma_s = std::max(parts[k].time_offset_std_s, kMinSigma_s);
    const double off = (parts[k].time_offset_s - centre_s) / sigma_s;
    level.chi2 += std::min(off * off, kMaxSigmas * kMaxSigmas);
    if (std::abs(off) > kMaxSigmas) continue;
    weights += 1.0 / (sigma_s * sigma_s);
    sum += parts[k].time_offset_s / (sigma_s * sigma_s);
  }
  level.offset_s = weights > 0.0 ? sum / weights : centre_s;
  level.std_s = weights > 0.0 ? 1.0 / std::sqrt(weights) : std::numeric_limits<double>::infinity();
  return level;
}

// Residuals of the best straight line, for drifting clocks.
double chi2OfLine(const std::vector<OffsetPart>& parts) {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d vector = Eigen::Vector2d::Zero();
  for (const OffsetPart& part : parts) {
    const Eigen::Vector2d row(1.0, part.begin_s);
    matrix += row * row.transpose();
    vector += row * part.time_offset_s;
  }
  const Eigen::Vector2d line = matrix.ldlt().solve(vector);
  std::vector<OffsetPart> rest = parts;
  for (OffsetPart& part : rest) part.time_offset_s -= line[0] + line[1] * part.begin_s;
  return levelOf(rest, 0, rest.size()).chi2;
}

}  // namespace

std::vector<OffsetPart> offsetsByParts(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                       const RelativeRotation& whole, const InitialisationOptions& options) {
  std::vector<RotationPair> pairs = rotationPairs(poses, options.pair_gap_s, options.max_pair_s);
  std::erase_if(pairs, [&](const RotationPair& pair) {
    return !gyro.covers(pair.from_s + whole.time_offset_s - kReach_s - kPartGrid_s,
                        pair.to_s + whole.time_offset_s + kReach_s + kPartGrid_s);
  });
  std::vector<OffsetPart> parts;
  constexpr std::size_t kMinPairs = 8;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    while (end < pairs.size() && pairs[end].from_s < pairs[begin].from_s + kPart_s) ++end;
    if (end - begin < kMinPairs) continue;
    const std::vector<RotationPair> own(pairs.begin() + static_cast<std::ptrdiff_t>(begin),
                                        pairs.begin() + static_cast<std::ptrdiff_t>(end));
    if (const auto part = Part(thinned(own), gyro, whole).offset()) parts.push_back(*part);
  }
  return parts;
}

std::optional<ClockStep> findClockStep(const std::vector<OffsetPart>& parts) {
  constexpr double kSure_sigmas = 6.0, kMinStep_s = 2e-3;
  constexpr std::size_t kMinParts = 2;  // on either side: a single part may be wrong
  const double one_level = levelOf(parts, 0, parts.size()).chi2;
  std::optional<ClockStep> best;
  double least = one_level;
  for (std::size_t k = kMinParts; k + kMinParts <= parts.size(); ++k) {
    const PartLevel before = levelOf(parts, 0, k), after = levelOf(parts, k, parts.size());
    if (before.chi2 + after.chi2 >= least) continue;
    least = before.chi2 + after.chi2;
    const double step_s = after.offset_s - before.offset_s;
    best = ClockStep{parts[k].begin_s, step_s, std::abs(step_s) / std::hypot(before.std_s, after.std_s),
                     2 * k >= parts.size()};
  }
  // The residual of two levels must be noise; for drifting clocks it is not.
  constexpr double kFarBetter = 0.5;
  if (!best || best->sigmas < kSure_sigmas || std::abs(best->step_s) < kMinStep_s ||
      least > kFarBetter * std::min(one_level, chi2OfLine(parts)))
    return std::nullopt;
  return best;
}

}  // namespace evical
