#include "core/maintenance/pair_tracking.h"

#include "core/maintenance/pair_information.h"
#include "core/numerics/angles.h"
#include "core/numerics/chi_squared.h"
#include "core/numerics/robust.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr std::array<std::size_t, 12> kLengths = {1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 25};  // windows
constexpr std::size_t kReference = 4;  // of kLengths: what the noise's colour is told by
constexpr std::size_t kSettled = 6;    // windows from a segment's start to the first test
constexpr Eigen::Index kOffset = 6, kDrift = kPairNumbers;
constexpr double kStart_s = 120.0;  // of the log that the old result is compared with

struct Believed {
  PairStateVector mean = PairStateVector::Zero();
  PairStateMatrix covariance = PairStateMatrix::Zero();
};

PairStateVector openVariances() {
  PairStateVector variance;
  constexpr double kDrift_s_s = 1e-4;
  variance << Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(0.3), 0.02,
      Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(1.0), kDrift_s_s;
  return variance.cwiseAbs2();
}

PairStateMatrix transition(double step_s) {
  PairStateMatrix f = PairStateMatrix::Identity();
  f(kOffset, kDrift) = step_s;
  return f;
}

class Tracker {
 public:
  Tracker(std::span<const WeighedWindow> windows, const PairModel& model, double alarm_probability,
          double coloured, const MaintenanceOptions& options)
      : windows_(windows), options_(options), coloured_(coloured) {
    stability_ << pairStability(options), 0.0;
    constexpr double kHour_s = 3600.0, kDriftWalk = 1e-9;
    walk_ = stability_ / kHour_s;
    walk_.segment<3>(7).setConstant(model.gyroscope_walk * model.gyroscope_walk);
    walk_.segment<3>(10).setConstant(model.accelerometer_walk * model.accelerometer_walk);
    walk_[kDrift] = kDriftWalk * kDriftWalk;
    const double tests =
        static_cast<double>(std::max<std::size_t>(windows.size(), 1) * kLengths.size() * kPairBlocks.size());
    probability_ = alarm_probability / tests;
    for (const StateBlock& block : kPairBlocks)
      limits_.push_back(chiSquaredLimit(probability_, static_cast<int>(block.size)));
  }

  void run() {
    believed_.assign(windows_.size() + 1, {});
    believed_[0].covariance = openVariances().asDiagonal();
    for (std::size_t end = 0; end < windows_.size(); ++end) {
      update(end);
      if (const auto alarm = alarmAt(end)) end = takeStep(end, *alarm);
    }
  }

  const std::vector<PairStep>& steps() const { return steps_; }
  std::size_t firstChange() const { return first_change_; }
  const Believed& after(std::size_t window) const { return believed_[window + 1]; }
  // How far statistics are above what chance makes of them, in the middle.
  double colour() const {
    double largest = 1.0;
    for (std::size_t b = 0; b < kPairBlocks.size(); ++b) {
      constexpr std::size_t kFewest = 20;
      if (statistics_[b].size() < kFewest || kPairBlocks[b].size < 3) continue;
      const double half = chiSquaredLimit(0.5, static_cast<int>(kPairBlocks[b].size));
      largest = std::max(largest, medianOf(statistics_[b]) / half);
    }
    return largest;
  }

 private:
  double stepOf(std::size_t window) const {
    return window == 0 ? options_.window_s : windows_[window].time_s - windows_[window - 1].time_s;
  }

  // believed_[w] is before window w's data, believed_[w + 1] after them and the way to the next.
  void update(std::size_t w) {
    const Believed& before = believed_[w];
    const PairStateMatrix h = windows_[w].information / coloured_;
    const PairStateMatrix gain =
        (PairStateMatrix::Identity() + before.covariance * h).partialPivLu().solve(before.covariance);
    Believed after;
    after.covariance = 0.5 * (gain + gain.transpose());
    after.mean = before.mean + after.covariance * (windows_[w].score / coloured_ - h * before.mean);
    const double step_s = w + 1 < windows_.size() ? stepOf(w + 1) : options_.window_s;
    const PairStateMatrix f = transition(step_s);
    after.mean = f * after.mean;
    after.covariance = f * after.covariance * f.transpose();
    after.covariance.diagonal() += step_s * walk_;
    believed_[w + 1] = after;
  }

  // Data of windows from..end about the state before `from`.
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
      sum.information += windows_[w].information / coloured_;
      sum.score += (windows_[w].score - windows_[w].information * expected) / coloured_;
    }
    const double length_s = windows_[end].time_s - windows_[from].time_s + options_.window_s;
    sum.covariance = before.covariance;
    sum.covariance.diagonal() += stability_ + length_s * walk_;
    // An offset that drifts changes over the windows by what is not known of its drift.
    sum.covariance(kOffset, kOffset) += length_s * length_s * before.covariance(kDrift, kDrift);
    return sum;
  }

  // Without what may change by itself, which would hide it.
  void noteColour(const Evidence& data) {
    PairStateMatrix covariance = data.covariance;
    covariance.diagonal() -= stability_;
    const ChangeTest test(data.information, data.score, covariance);
    for (std::size_t b = 0; b < kPairBlocks.size(); ++b)
      statistics_[b].push_back(test.of(kPairBlocks[b]).chi_square);
  }

  struct Alarm {
    std::size_t from = 0;
    double beyond = -std::numeric_limits<double>::infinity();
  };
  Alarm strongest(std::size_t from, std::size_t end) const {
    const Evidence data = evidence(from, end);
    const ChangeTest test(data.information, data.score, data.covariance);
    Alarm alarm{from, -std::numeric_limits<double>::infinity()};
    for (std::size_t b = 0; b < kPairBlocks.size(); ++b)
      alarm.beyond = std::max(alarm.beyond, test.of(kPairBlocks[b]).chi_square - limits_[b]);
    return alarm;
  }

  std::optional<Alarm> alarmAt(std::size_t end) {
    Alarm best;
    for (std::size_t k = 0; k < kLengths.size(); ++k) {
      const std::size_t length = kLengths[k];
      if (end + 1 < segment_ + kSettled + length) break;
      const std::size_t from = end + 1 - length;
      const Evidence data = evidence(from, end);
      if (k == kReference) noteColour(data);
      const ChangeTest test(data.information, data.score, data.covariance);
      for (std::size_t b = 0; b < kPairBlocks.size(); ++b) {
        const double statistic = test.of(kPairBlocks[b]).chi_square;
        if (statistic - limits_[b] > best.beyond) best = {from, statistic - limits_[b]};
      }
    }
    if (best.beyond > 0.0) return best;
    return std::nullopt;
  }

  // Waits until enough is known of what has changed; returns the last window that was used for that.
  std::size_t takeStep(std::size_t noticed, Alarm alarm) {
    const auto wait = static_cast<std::size_t>(std::ceil(options_.naming_s / options_.window_s));
    const std::size_t end = std::min(std::max(noticed, alarm.from + wait - 1), windows_.size() - 1);
    for (std::size_t w = noticed + 1; w <= end; ++w) update(w);
    const std::size_t longest = kLengths.back() + wait;
    const std::size_t earliest = std::max(segment_ + kSettled, end > longest ? end - longest : 0);
    Alarm best;
    for (std::size_t from = earliest; from <= end; ++from) {
      const Alarm here = strongest(from, end);
      if (here.beyond > best.beyond) best = here;
    }
    const std::size_t from = best.beyond > 0.0 ? best.from : alarm.from;
    const Evidence data = evidence(from, end);
    const auto found = findChanges(data.information, data.score, data.covariance, kPairBlocks, probability_);
    for (const FoundChange& each : found)
      steps_.push_back({each.block, windows_[from].time_s, windows_[noticed].time_s + options_.window_s,
                        each.change, limits_[each.block], each.or_else});
    first_change_ = std::min(first_change_, from);
    beginSegment(from, found, end);
    return end;
  }

  // All that has changed is open again from there.
  void beginSegment(std::size_t from, const std::vector<FoundChange>& found, std::size_t end) {
    const PairStateVector open = openVariances();
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
  double coloured_, probability_ = 0.0;
  PairStateVector stability_, walk_;
  std::vector<double> limits_;
  std::vector<Believed> believed_;
  std::array<std::vector<double>, kPairBlocks.size()> statistics_;
  std::vector<PairStep> steps_;
  std::size_t segment_ = 0, first_change_ = std::numeric_limits<std::size_t>::max();
};

void setStart(std::span<const WeighedWindow> windows, std::size_t first_change, double coloured,
              PairTrack& track) {
  for (std::size_t w = 0; w < windows.size() && w < first_change; ++w) {
    if (windows[w].time_s > windows.front().time_s + kStart_s) break;
    track.start_information += windows[w].information.topLeftCorner<kPairNumbers, kPairNumbers>() / coloured;
    track.start_score += windows[w].score.head<kPairNumbers>() / coloured;
  }
  PairMatrix whole = track.start_information;
  whole.diagonal() += openVariances().head<kPairNumbers>().cwiseInverse();
  const Eigen::PartialPivLU<PairMatrix> solver(whole);
  track.start_covariance = solver.solve(PairMatrix::Identity());
  track.start = track.start_covariance * track.start_score;
}

}  // namespace

PairVector pairStability(const MaintenanceOptions& options) {
  PairVector stability;
  stability << Eigen::Vector3d::Constant(options.stability_rotation_deg * kRadPerDeg),
      Eigen::Vector3d::Constant(1e-3 * options.stability_translation_mm),
      1e-3 * options.stability_time_offset_ms,
      Eigen::Vector3d::Constant(options.stability_gyroscope_bias_rad_s),
      Eigen::Vector3d::Constant(options.stability_accelerometer_bias_m_s2);
  constexpr double kLeast = 1e-9;
  return stability.cwiseMax(kLeast).cwiseAbs2();
}

PairTrack trackPair(std::span<const PairWindow> windows, const PairModel& model, double alarm_probability,
                    const MaintenanceOptions& options) {
  PairTrack track;
  if (windows.empty()) return track;
  const WeighedWindows all = weighed(windows, model);
  track.gyroscope_noise_rad_s = all.gyroscope_noise_rad_s;
  track.accelerometer_noise_m_s2 = all.accelerometer_noise_m_s2;
  constexpr int kRounds = 3;
  constexpr double kWhite = 1.8;  // of a minute, medians scatter
  for (int round = 0; round < kRounds; ++round) {
    Tracker tracker(all.windows, model, alarm_probability, track.coloured, options);
    tracker.run();
    const double colour = tracker.colour();
    if (colour > kWhite && round + 1 < kRounds) {
      track.coloured *= colour;
      continue;
    }
    track.steps = tracker.steps();
    for (std::size_t w = 0; w < all.windows.size(); ++w) {
      const Believed& now = tracker.after(w);
      track.times_s.push_back(all.windows[w].time_s + options.window_s);
      track.values.push_back(now.mean.head<kPairNumbers>());
      track.sigmas.push_back(now.covariance.diagonal().head<kPairNumbers>().cwiseMax(0.0).cwiseSqrt());
    }
    setStart(all.windows, tracker.firstChange(), track.coloured, track);
    break;
  }
  return track;
}

}  // namespace evical
