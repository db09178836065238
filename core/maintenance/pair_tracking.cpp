#include "core/maintenance/pair_tracking.h"

#include "core/maintenance/maintenance_options.h"

#include "core/numerics/angles.h"
#include "core/numerics/chi_squared.h"
#include "core/numerics/robust.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace evical {
namespace {

// Replaces 1 / n if a mean of n is compared with one of the m before it: for sums with variances n A - B, the
// B terms of both and of their correlation, over 1 / n + 1 / m.
double lostShare(double n, double m) {
  return (1.0 / (n * n) + 1.0 / (m * m) + 1.0 / (n * m)) / (1.0 / n + 1.0 / m);
}

}  // namespace

double NoiseAutocorrelation::of(std::size_t windows) const {
  return std::max(1.0, settled - lost / static_cast<double>(windows));
}

double NoiseAutocorrelation::ofMany() const {
  return std::max(1.0, settled);
}

// Chi squared with an estimated variance follows Fisher's distribution: its quantiles to first order in 1 /
// freedom.
double NoiseAutocorrelation::limit(double white, Eigen::Index numbers, double wider) const {
  const double estimated = 1.0 - 1.0 / wider;
  const double further = (white + 2.0 - static_cast<double>(numbers)) / (2.0 * freedom);
  return wider * white * (1.0 + estimated * std::max(0.0, further));
}

// Weighted least squares fit to the medians; for n windows, one n-th of the values are independent.
NoiseAutocorrelation ColourStatistics::colour() const {
  constexpr std::size_t kFewest = 12;
  constexpr double kShare =
      0.2;  // of the windows: degrees of freedom, reduced by the scatter of medians and by extrapolation
  const double by_chance = chiSquaredLimit(0.5, dimension_);
  double weights = 0.0, x = 0.0, xx = 0.0, y = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < kLengths.size(); ++k) {
    if (values_[k].size() < kFewest) continue;
    const auto n = static_cast<double>(kLengths[k]);
    const double weight = 1.0 / n, share = lostShare(n, static_cast<double>(before_)),
                 wider = medianOf(values_[k]) / by_chance;
    weights += weight;
    x += weight * share;
    xx += weight * share * share;
    y += weight * wider;
    xy += weight * share * wider;
  }
  const double spread = weights * xx - x * x;
  if (!(spread > 1e-9)) return {};
  const double slope = (weights * xy - x * y) / spread;
  return {(y - slope * x) / weights, -slope, kShare * static_cast<double>(values_.front().size())};
}

namespace {

constexpr std::array<std::size_t, 12> kLengths = {1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 25};  // windows
constexpr Eigen::Index kOffset = 6, kDrift = kPairNumbers;

struct Believed {
  PairStateVector mean = PairStateVector::Zero();
  PairStateMatrix covariance = PairStateMatrix::Zero();
};

PairStateVector openVariances(const MaintenanceOptions& options) {
  PairStateVector variance;
  variance << Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(0.3), 0.02,
      Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(1.0), 1e-6 * options.time_offset_drift_ppm;
  return variance.cwiseAbs2();
}

PairStateMatrix transition(double step_s) {
  PairStateMatrix f = PairStateMatrix::Identity();
  f(kOffset, kDrift) = step_s;
  return f;
}

PairStateVector walkOf(const PairModel& model, const MaintenanceOptions& options) {
  constexpr double kHour_s = 3600.0, kDriftWalk = 1e-9;
  PairStateVector walk;
  walk << pairStability(options) / kHour_s, kDriftWalk * kDriftWalk;
  walk.segment<3>(7).setConstant(model.gyroscope_walk * model.gyroscope_walk);
  walk.segment<3>(10).setConstant(model.accelerometer_walk * model.accelerometer_walk);
  return walk;
}

using PairColours = std::array<NoiseAutocorrelation, kPairBlocks.size()>;

// Compares groups of a few windows with those just before them: they differ only by noise, or by a change in
// between.
PairColours coloursOf(std::span<const WeighedWindow> windows, const PairModel& model,
                      const MaintenanceOptions& options) {
  constexpr std::size_t kBefore = 16;
  constexpr auto& kCompared = ColourStatistics::kLengths;
  const std::size_t before = std::min(kBefore, windows.size() / 3);
  const PairStateVector walk = walkOf(model, options);
  const PairStateMatrix open = openVariances(options).cwiseInverse().asDiagonal();
  std::vector<ColourStatistics> statistics;
  for (const StateBlock& block : kPairBlocks) statistics.emplace_back(static_cast<int>(block.size), before);
  for (std::size_t from = before; from < windows.size(); ++from) {
    PairStateMatrix known = open, information = PairStateMatrix::Zero();
    PairStateVector right = PairStateVector::Zero(), score = PairStateVector::Zero();
    for (std::size_t w = from - before; w < from; ++w) {
      known += windows[w].information;
      right += windows[w].score;
    }
    const Eigen::PartialPivLU<PairStateMatrix> solver(known);
    const PairStateVector mean = solver.solve(right);
    PairStateMatrix covariance = solver.solve(PairStateMatrix::Identity());
    covariance.diagonal() += static_cast<double>(before) * options.window_s * walk;
    for (std::size_t k = 0, end = from; k < kCompared.size() && from + kCompared[k] <= windows.size(); ++k) {
      for (; end < from + kCompared[k]; ++end) {
        information += windows[end].information;
        score += windows[end].score;
      }
      const ChangeDetector test(information, score - information * mean, covariance);
      for (std::size_t b = 0; b < kPairBlocks.size(); ++b)
        statistics[b].add(k, test.of(kPairBlocks[b]).chi_square);
    }
  }
  PairColours colours;
  for (std::size_t b = 0; b < colours.size(); ++b) colours[b] = statistics[b].colour();
  return colours;
}

class Tracker {
 public:
  Tracker(std::span<const WeighedWindow> windows, const PairModel& model, double alarm_probability,
          const PairColours& colours, const MaintenanceOptions& options)
      : windows_(windows), options_(options), colours_(colours) {
    stability_ << pairStability(options), 0.0;
    walk_ = walkOf(model, options);
    settled_ = static_cast<std::size_t>(std::ceil(options.settled_s / options.window_s));
    const double tests =
        static_cast<double>(std::max<std::size_t>(windows.size(), 1) * kLengths.size() * kPairBlocks.size());
    white_limits_ = limitsFor(kPairBlocks, alarm_probability / tests);
  }

  void run() {
    believed_.assign(windows_.size() + 1, {});
    believed_[0].covariance = openVariances(options_).asDiagonal();
    for (std::size_t end = 0; end < windows_.size(); ++end) {
      update(end);
      if (const auto alarm = alarmAt(end)) end = takeStep(end, *alarm);
    }
  }

  const std::vector<PairStep>& steps() const { return steps_; }
  std::size_t firstChange() const { return first_change_; }
  const Believed& after(std::size_t window) const { return believed_[window + 1]; }

 private:
  double stepOf(std::size_t window) const {
    return window == 0 ? options_.window_s : windows_[window].time_s - windows_[window - 1].time_s;
  }

  // believed_[w] is the state before window w's data; believed_[w + 1] is after them, propagated to the next
  // window.
  void update(std::size_t w) {
    const Believed& before = believed_[w];
    const PairStateMatrix h = windows_[w].information;
    const PairStateMatrix gain =
        (PairStateMatrix::Identity() + before.covariance * h).partialPivLu().solve(before.covariance);
    Believed after;
    after.covariance = 0.5 * (gain + gain.transpose());
    after.mean = before.mean + after.covariance * (windows_[w].score - h * before.mean);
    const double step_s = w + 1 < windows_.size() ? stepOf(w + 1) : options_.window_s;
    const PairStateMatrix f = transition(step_s);
    after.mean = f * after.mean;
    after.covariance = f * after.covariance * f.transpose();
    after.covariance.diagonal() += step_s * walk_;
    believed_[w + 1] = after;
  }

  // Data of windows from..end relative to the state before `from`.
  struct Evidence {
    PairStateMatrix information = PairStateMatrix::Zero(), covariance;
    PairStateVector score = PairStateVector::Zero();
  };
  Evidence evidence(std::size_t from, std::size_t end) const {
    Evidence sum;
    const Believed& before = believed_[from];
    for (std::size_t w = from; w <= end; ++w) {
      const double since_s = windows_[w].time_s - windows_[from].time_s;
      PairStateVector expected = before.mean;
      expected[kOffset] += since_s * before.mean[kDrift];
      sum.information += windows_[w].information;
      sum.score += windows_[w].score - windows_[w].information * expected;
    }
    const double length_s = windows_[end].time_s - windows_[from].time_s + options_.window_s;
    sum.covariance = before.covariance;
    sum.covariance.diagonal() += stability_ + length_s * walk_;
    // The uncertainty of an offset's drift increases its variance over the windows.
    sum.covariance(kOffset, kOffset) += length_s * length_s * before.covariance(kDrift, kDrift);
    return sum;
  }

  // Limits for data of this many windows.
  std::vector<double> limitsOf(std::size_t length) const {
    std::vector<double> limits = white_limits_;
    for (std::size_t b = 0; b < limits.size(); ++b)
      limits[b] = colours_[b].limit(limits[b], kPairBlocks[b].size, colours_[b].of(length));
    return limits;
  }

  struct Alarm {
    std::size_t from = 0;
    double beyond = -std::numeric_limits<double>::infinity();
  };
  Alarm strongest(std::size_t from, std::size_t end, const std::vector<double>& limits) const {
    const Evidence data = evidence(from, end);
    const ChangeDetector test(data.information, data.score, data.covariance);
    Alarm alarm{from, -std::numeric_limits<double>::infinity()};
    for (std::size_t b = 0; b < kPairBlocks.size(); ++b)
      alarm.beyond = std::max(alarm.beyond, test.of(kPairBlocks[b]).chi_square - limits[b]);
    return alarm;
  }

  std::optional<Alarm> alarmAt(std::size_t end) {
    Alarm best;
    for (const std::size_t length : kLengths) {
      if (end + 1 < segment_ + settled_ + length) break;
      const std::size_t from = end + 1 - length;
      const Alarm here = strongest(from, end, limitsOf(length));
      if (here.beyond > best.beyond) best = here;
    }
    if (best.beyond > 0.0) return best;
    return std::nullopt;
  }

  // Collects data until the change can be identified; returns the last window used for that.
  std::size_t takeStep(std::size_t noticed, Alarm alarm) {
    const auto wait = static_cast<std::size_t>(std::ceil(options_.naming_s / options_.window_s));
    const std::size_t end = std::min(std::max(noticed, alarm.from + wait - 1), windows_.size() - 1);
    for (std::size_t w = noticed + 1; w <= end; ++w) update(w);
    const std::size_t longest = kLengths.back() + wait;
    const std::size_t earliest = std::max(segment_ + settled_, end > longest ? end - longest : 0);
    // With limits that grow with time, the later of two moments with the same evidence would be chosen.
    Alarm best;
    for (std::size_t from = earliest; from <= end; ++from) {
      const Alarm here = strongest(from, end, white_limits_);
      if (here.beyond > best.beyond) best = here;
    }
    const std::size_t from = best.beyond > 0.0 ? best.from : alarm.from;
    const Evidence data = evidence(from, end);
    const std::vector<double> limits = limitsOf(end + 1 - from);
    const auto found = findChanges(data.information, data.score, data.covariance, kPairBlocks, limits);
    for (const FoundChange& each : found) {
      steps_.push_back({each.block, windows_[from].time_s, windows_[noticed].time_s + options_.window_s,
                        each.change, limits[each.block], each.alternatives});
      steps_.back().change.covariance *= colours_[each.block].of(end + 1 - from);
    }
    first_change_ = std::min(first_change_, from);
    beginSegment(from, found, end);
    return end;
  }

  // Resets everything that has changed to its prior from there on.
  void beginSegment(std::size_t from, const std::vector<FoundChange>& found, std::size_t end) {
    const PairStateVector open = openVariances(options_);
    for (const FoundChange& each : found) {
      const StateBlock& block = kPairBlocks[each.block];
      for (Eigen::Index i = block.first; i < block.first + block.size; ++i)
        believed_[from].covariance(i, i) += open[i];
    }
    segment_ = from;
    for (std::size_t w = from; w <= end; ++w) update(w);
  }

  std::span<const WeighedWindow> windows_;
  const MaintenanceOptions& options_;
  PairColours colours_;
  PairStateVector stability_, walk_;
  std::vector<double> white_limits_;
  std::vector<Believed> believed_;
  std::vector<PairStep> steps_;
  std::size_t settled_ = 0, segment_ = 0, first_change_ = std::numeric_limits<std::size_t>::max();
};

PairVector widerSigmas(const PairColours& colours) {
  PairVector factors;
  for (std::size_t b = 0; b < colours.size(); ++b)
    factors.segment(kPairBlocks[b].first, kPairBlocks[b].size).setConstant(std::sqrt(colours[b].ofMany()));
  return factors;
}

void setStart(std::span<const WeighedWindow> windows, std::size_t first_change, const PairVector& wider,
              const MaintenanceOptions& options, PairTrack& track) {
  for (std::size_t w = 0; w < windows.size() && w < first_change; ++w) {
    if (windows[w].time_s > windows.front().time_s + options.start_s) break;
    track.start_information += windows[w].information.topLeftCorner<kPairNumbers, kPairNumbers>();
    track.start_score += windows[w].score.head<kPairNumbers>();
  }
  PairMatrix whole = track.start_information;
  whole.diagonal() += openVariances(options).head<kPairNumbers>().cwiseInverse();
  const Eigen::PartialPivLU<PairMatrix> solver(whole);
  const PairMatrix covariance = solver.solve(PairMatrix::Identity());
  track.start = covariance * track.start_score;
  track.start_covariance = wider.asDiagonal() * covariance * wider.asDiagonal();
}

}  // namespace

PairVector pairStability(const MaintenanceOptions& options) {
  PairVector stability;
  stability << Eigen::Vector3d::Constant(options.stability_rotation_deg * kRadPerDeg),
      Eigen::Vector3d::Constant(1e-3 * options.stability_translation_mm),
      1e-3 * options.stability_time_offset_ms,
      Eigen::Vector3d::Constant(options.stability_gyroscope_bias_rad_s),
      Eigen::Vector3d::Constant(options.stability_accelerometer_bias_m_s2);
  constexpr double kMin = 1e-9;
  return stability.cwiseMax(kMin).cwiseAbs2();
}

PairTrack trackPair(std::span<const PairWindow> windows, const PairModel& model, double alarm_probability,
                    const MaintenanceOptions& options) {
  PairTrack track;
  if (windows.empty()) return track;
  const WeighedWindows all = weighed(windows, model, options);
  track.gyroscope_noise_rad_s = all.gyroscope_noise_rad_s;
  track.accelerometer_noise_m_s2 = all.accelerometer_noise_m_s2;
  track.colours = coloursOf(all.windows, model, options);
  const PairVector wider = widerSigmas(track.colours);
  Tracker tracker(all.windows, model, alarm_probability, track.colours, options);
  tracker.run();
  track.steps = tracker.steps();
  for (std::size_t w = 0; w < all.windows.size(); ++w) {
    const Believed& now = tracker.after(w);
    track.times_s.push_back(all.windows[w].time_s + options.window_s);
    track.values.push_back(now.mean.head<kPairNumbers>());
    track.sigmas.push_back(
        wider.cwiseProduct(now.covariance.diagonal().head<kPairNumbers>().cwiseMax(0.0).cwiseSqrt()));
  }
  setStart(all.windows, tracker.firstChange(), wider, options, track);
  return track;
}

namespace {

// Neighbouring points are at a distance of three sigmas of the smoothing: they share exp(-9/4) of their noise
// on either side.
const double kShared = 1.0 + 2.0 * std::exp(-2.25);

struct OwnFit {
  double squares = 0.0;
  int freedom = 0;

  double variance() const { return squares / freedom; }
};

// Residual of a window with all numbers estimated from it: noise, independent of changes.
OwnFit ownFit(const PairEquations& equations) {
  const PairVector scale = equations.information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const PairMatrix scaled = scale.asDiagonal() * equations.information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<PairMatrix> eigen(scaled);
  const PairVector along = eigen.eigenvectors().transpose() * scale.cwiseProduct(equations.score);
  constexpr double kMin = 1e-8;
  OwnFit fit{equations.squares, equations.count};
  for (Eigen::Index i = 0; i < kPairNumbers; ++i) {
    if (eigen.eigenvalues()[i] < kMin) continue;
    fit.squares -= along[i] * along[i] / eigen.eigenvalues()[i];
    --fit.freedom;
  }
  fit.squares = std::max(fit.squares, 0.0);
  return fit;
}

double typicalVariance(const std::vector<OwnFit>& fits) {
  constexpr int kFewest = 10;
  std::vector<double> variances;
  double freedom = 0.0;
  for (const OwnFit& fit : fits) {
    if (fit.freedom < kFewest) continue;
    variances.push_back(fit.variance());
    freedom += fit.freedom;
  }
  if (variances.empty()) return 0.0;
  // Median of chi squared divided by its degrees of freedom (E. B. Wilson, M. M. Hilferty 1931).
  const double mean_freedom = freedom / static_cast<double>(variances.size());
  return medianOf(std::move(variances)) / std::pow(1.0 - 2.0 / (9.0 * mean_freedom), 3);
}

// Reduces the weight of a window with far more noise than others (a shock, a spike).
double varianceOf(const OwnFit& fit, double typical, double restless) {
  return fit.freedom > 0 && fit.variance() > restless * typical ? fit.variance() : typical;
}

// Noise in the slope of the rate is in the lever's Jacobian and, times the lever, in the residual: its square
// imitates information for a lever of zero. Its expectation is subtracted; if it dominates, all of the
// information is removed.
void takeNoiseOff(const PairModel& model, double rate_variance, double force_variance, const PairWindow& raw,
                  double mostly_noise, PairEquations& gyroscope, PairEquations& accelerometer) {
  const double by_slope = 0.5 / (model.smoothing_s * model.smoothing_s);
  const double slope_variance = 0.5 * rate_variance * by_slope;  // of one of the two IMUs
  const double jerk_variance = 0.5 * force_variance * by_slope;
  const double points = raw.accelerometer.count / 3.0;
  const double turning = raw.gyroscope.information(6, 6);  // sum of the slopes' squares
  const bool tells = turning > mostly_noise * 3.0 * slope_variance * raw.gyroscope.count / 3.0;
  if (tells) {
    accelerometer.information.block<3, 3>(3, 3) -=
        2.0 * points * slope_variance * Eigen::Matrix3d::Identity();
    accelerometer.score.segment<3>(3) += 2.0 * points * slope_variance * model.lever_m;
  } else {
    accelerometer.information.middleRows<3>(3).setZero();
    accelerometer.information.middleCols<3>(3).setZero();
    accelerometer.score.segment<3>(3).setZero();
  }
  const auto withoutOffset = [&](PairEquations& equations, double noise) {
    if (equations.information(6, 6) > mostly_noise * noise) {
      equations.information(6, 6) -= noise;
      return;
    }
    equations.information.row(6).setZero();
    equations.information.col(6).setZero();
    equations.score[6] = 0.0;
  };
  withoutOffset(gyroscope, slope_variance * raw.gyroscope.count);
  withoutOffset(accelerometer, jerk_variance * raw.accelerometer.count);
}

}  // namespace

WeighedWindows weighed(std::span<const PairWindow> windows, const PairModel& model,
                       const MaintenanceOptions& options) {
  std::vector<OwnFit> rates, forces;
  for (const PairWindow& window : windows) {
    rates.push_back(ownFit(window.gyroscope));
    forces.push_back(ownFit(window.accelerometer));
  }
  constexpr double kMin = 1e-20;
  const double rate_variance = std::max(typicalVariance(rates), kMin),
               force_variance = std::max(typicalVariance(forces), kMin);
  WeighedWindows all;
  all.gyroscope_noise_rad_s = std::sqrt(rate_variance);
  all.accelerometer_noise_m_s2 = std::sqrt(force_variance);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    PairEquations gyroscope = windows[w].gyroscope, accelerometer = windows[w].accelerometer;
    takeNoiseOff(model, rate_variance, force_variance, windows[w], options.mostly_noise, gyroscope,
                 accelerometer);
    const double by_rate = 1.0 / (kShared * varianceOf(rates[w], rate_variance, options.restless_window)),
                 by_force = 1.0 / (kShared * varianceOf(forces[w], force_variance, options.restless_window));
    WeighedWindow& each = all.windows.emplace_back();
    each.time_s = windows[w].time_s;
    each.information.topLeftCorner<kPairNumbers, kPairNumbers>() =
        by_rate * gyroscope.information + by_force * accelerometer.information;
    each.score.head<kPairNumbers>() = by_rate * gyroscope.score + by_force * accelerometer.score;
  }
  return all;
}

}  // namespace evical
