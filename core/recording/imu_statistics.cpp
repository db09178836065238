#include "core/recording/imu_statistics.h"

#include "core/recording/inspection.h"

#include "core/base/number.h"
#include "core/base/time.h"
#include "core/data/imu_stamps.h"
#include "core/data/second_clock.h"
#include "core/data/stamp_batches.h"
#include "core/data/unfit_samples.h"
#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kMaxFirstSamples = 10;  // stamped before the driver's clock is set
constexpr double kUnset_s = 3600.0;
constexpr double kMinRaw_m_s2 = 200.0;    // norms from here on are raw counts
constexpr std::size_t kFewestEqual = 10;  // samples whose times are not equal by chance

using Faults = std::vector<RecordingFault>;
using Samples = std::vector<ImuSample>;

// Lists the first few of many similar faults, and their number.
void appendFaults(Faults& faults, Faults alike, const char* many) {
  if (std::ssize(alike) > kMostAlikeFaults) {
    RecordingFault rest = alike[kMostAlikeFaults];
    rest.text = fmt::format("{} more {}.", std::ssize(alike) - kMostAlikeFaults, many);
    alike.resize(kMostAlikeFaults);
    alike.push_back(rest);
  }
  faults.insert(faults.end(), alike.begin(), alike.end());
}

constexpr auto kIsEarlier = [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; };

bool areSorted(const Samples& samples) {
  return std::is_sorted(samples.begin(), samples.end(), kIsEarlier);
}

void checkTimes(const std::string& name, const Samples& samples, const InspectionOptions& options,
                Faults& faults) {
  const std::vector<SecondClock> clocks = findSecondClocks(samples);
  for (const SecondClock& clock : clocks)
    faults.push_back(faultOf(name, samples.front().time_ns, samples, clock));
  const auto isOfSecondClock = [&](std::size_t i) {
    return std::any_of(clocks.begin(), clocks.end(),
                       [i](const SecondClock& clock) { return i >= clock.begin && i <= clock.end; });
  };
  std::vector<std::int64_t> times_ns;
  for (const ImuSample& sample : samples) times_ns.push_back(sample.time_ns);
  const std::optional<StampBatches> batches = areSorted(samples) ? findStampBatches(times_ns) : std::nullopt;
  if (batches) {
    faults.push_back({name, FaultKind::Jitter, 0.0, fmt::format("The {}.", batches->text())});
    return;  // the gaps are between batches
  }
  const double period_s = medianInterval_s(samples);
  Faults gaps, backward;
  double square_sum_s2 = 0.0;
  std::size_t regular = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (isOfSecondClock(i)) continue;
    const double at_s = secondsSince(samples.front().time_ns, samples[i - 1].time_ns);
    const double interval_s = secondsSince(samples[i - 1].time_ns, samples[i].time_ns);
    const bool late = interval_s > options.imu_gap_periods * period_s && period_s > 0.0;
    if (i <= kMaxFirstSamples && interval_s > kUnset_s && late) {
      faults.push_back(
          {name, FaultKind::Corrupt, 0.0,
           fmt::format(
               "The first {} samples are stamped {:.3f} s before the next one; the clock was probably "
               "not set yet. Calibrations exclude them.",
               i, interval_s)});
    } else if (interval_s < 0.0) {
      const char* reset =
          samples[i - 1].time_ns - samples[i].time_ns > kClockReset_ns ? "; the clock was reset" : "";
      backward.push_back(
          {name, FaultKind::BackwardTime, at_s,
           fmt::format("Time runs backwards by {:.3f} ms at sample {}{}.", -1e3 * interval_s, i, reset)});
    } else if (late) {
      gaps.push_back({name, FaultKind::Gap, at_s,
                      fmt::format("No samples for {:.3f} ms; the usual interval is {:.3f} ms.",
                                  1e3 * interval_s, 1e3 * period_s)});
    } else {
      square_sum_s2 += (interval_s - period_s) * (interval_s - period_s);
      ++regular;
    }
  }
  appendFaults(faults, std::move(gaps), "gaps");
  appendFaults(faults, std::move(backward), "steps back in time");
  const double jitter_s = regular > 0 ? std::sqrt(square_sum_s2 / static_cast<double>(regular)) : 0.0;
  if (jitter_s > options.imu_jitter_periods * period_s) {
    faults.push_back(
        {name, FaultKind::Jitter, 0.0,
         fmt::format("Sample intervals scatter by {:.3f} ms around {:.3f} ms: were samples stamped on "
                     "arrival?",
                     1e3 * jitter_s, 1e3 * period_s)});
  }
}

using Measures = bool (*)(const ImuSample&);

Samples ownSamples(const Samples& samples, Measures measures) {
  Samples own;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(own), measures);
  return own;
}

// Sensors that are sampled separately have separate times.
void checkTimesOfSensors(const std::string& name, const Samples& samples, const InspectionOptions& options,
                         Faults& faults) {
  const auto isOfBoth = [](const ImuSample& sample) { return sample.measured_by == MeasuredBy::Both; };
  if (std::all_of(samples.begin(), samples.end(), isOfBoth))
    return checkTimes(name, samples, options, faults);
  for (const Measures measures : {measuresRate<ImuSample>, measuresForce<ImuSample>})
    if (const Samples own = ownSamples(samples, measures); !own.empty())
      checkTimes(name, own, options, faults);
}

void checkStuck(const std::string& name, const Samples& samples, const ImuAxis& axis,
                const std::vector<std::size_t>& saturated, const InspectionOptions& options, Faults& faults) {
  Faults stuck;
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (axis.rate ? measuresRate(samples[i]) : measuresForce(samples[i])) own.push_back(i);
  for (std::size_t begin = 0, end = 0; begin < own.size(); begin = end) {
    const double value = axis.of(samples[own[begin]]);
    for (end = begin + 1; end < own.size() && axis.of(samples[own[end]]) == value;) ++end;
    const double at_s = secondsSince(samples.front().time_ns, samples[own[begin]].time_ns);
    const double run_s = secondsSince(samples[own[begin]].time_ns, samples[own[end - 1]].time_ns);
    if (run_s < options.stuck_axis_s || std::binary_search(saturated.begin(), saturated.end(), own[begin]))
      continue;
    stuck.push_back({name, FaultKind::StuckAxis, at_s,
                     fmt::format("{} stays at {} for {:.2f} s.", axis.name, value, run_s)});
  }
  appendFaults(faults, std::move(stuck), "such times");
}

void checkSaturated(const std::string& name, const Samples& samples, const ImuAxis& axis,
                    const std::vector<std::size_t>& saturated, Faults& faults) {
  if (saturated.empty()) return;
  faults.push_back(
      {name, FaultKind::SaturatedAxis,
       secondsSince(samples.front().time_ns, samples[saturated.front()].time_ns),
       fmt::format("{} is at its limit of {:.4g} for {}, which calibrations leave out: move more slowly, "
                   "or increase the IMU's range.",
                   axis.name, std::abs(axis.of(samples[saturated.front()])),
                   counted(saturated.size(), "sample"))});
}

void checkSpikes(const std::string& name, const Samples& samples, const char* sensor, Measures measures,
                 const std::vector<std::size_t>& spikes, Faults& faults) {
  constexpr std::size_t kMaxTimes = 5;
  if (spikes.empty()) return;
  const auto count = std::count_if(samples.begin(), samples.end(), measures);
  std::string times;
  for (std::size_t k = 0; k < std::min(spikes.size(), kMaxTimes); ++k)
    times += fmt::format("{}{:.3f} s", k > 0 ? ", " : "",
                         secondsSince(samples.front().time_ns, samples[spikes[k]].time_ns));
  faults.push_back(
      {name, FaultKind::Corrupt, secondsSince(samples.front().time_ns, samples[spikes.front()].time_ns),
       fmt::format(
           "{} of {} samples of the {} contradict their neighbours (at {}{}): calibrations leave them out.",
           spikes.size(), count, sensor, times, spikes.size() > kMaxTimes ? ", ..." : "")});
}

void checkUnits(const std::string& name, const Samples& samples, const InspectionOptions& options,
                Faults& faults) {
  const Samples forces = ownSamples(samples, measuresForce<ImuSample>);
  const double norm = medianForceNorm(forces);
  const bool raw = !forces.empty() && norm >= kMinRaw_m_s2;
  // Fast motion increases the norms, but not the norm of their mean in a frame that does not rotate.
  if (!forces.empty() && !isGravity(norm, options) &&
      !isGravity(steadyForceNorm(samples).value_or(norm), options)) {
    const bool in_g = isGravity(norm * kStandardGravity_m_s2, options);
    faults.push_back(
        {name, FaultKind::Unit, 0.0,
         fmt::format("The median norm of the specific force is {:.3f}, not 9.8 m/s^2{}.", norm,
                     in_g                           ? ": the file has it in g"
                     : norm < kStandardGravity_m_s2 ? ": gravity is removed, or the unit is another"
                     : !raw                         ? ": its unit is probably another"
                            : fmt::format("; are these raw counts? Give the size of a count "
                                          "as acceleration_unit; {:.3g} g would give gravity",
                                          1.0 / norm))});
  }
  const double fastest = largestRate(samples);
  if (fastest > options.largest_rate_rad_s) {
    faults.push_back(
        {name, FaultKind::Unit, 0.0,
         raw ? fmt::format(
                   "The angular rate reaches {:.1f}: too fast for rad/s; are these raw counts, too? Give "
                   "the size of a count as angular_rate_unit.",
                   fastest)
             : fmt::format("The angular rate reaches {:.1f}: too fast for rad/s, probably deg/s.", fastest)});
  }
}

}  // namespace

std::vector<RecordingFault> checkImu(const std::string& name, const std::vector<ImuSample>& recorded,
                                     const InspectionOptions& options) {
  Faults faults;
  Samples samples = recorded;
  if (samples.size() < 2) {
    faults.push_back({name, FaultKind::Empty, 0.0,
                      fmt::format("The stream has {}.", counted(samples.size(), "IMU sample"))});
    return faults;
  }
  const auto sameTime = [&](const ImuSample& sample) { return sample.time_ns == samples.front().time_ns; };
  if (samples.size() >= kFewestEqual && std::all_of(samples.begin(), samples.end(), sameTime)) {
    faults.push_back(
        {name, FaultKind::Corrupt, 0.0,
         fmt::format("All {} samples have the same time: it was rounded or never set. Export or record "
                     "them again with their times.",
                     samples.size())});
    return faults;  // everything else follows from it
  }
  Samples sorted = samples;  // without second clocks, as in a calibration
  const std::vector<SecondClock> clocks = findSecondClocks(samples);
  for (auto clock = clocks.rbegin(); clock != clocks.rend(); ++clock)
    sorted.erase(sorted.begin() + static_cast<std::ptrdiff_t>(clock->begin),
                 sorted.begin() + static_cast<std::ptrdiff_t>(clock->end));
  std::stable_sort(sorted.begin(), sorted.end(), kIsEarlier);
  const CoarseStamps stamps = reconstructStamps(sorted);
  if (stamps.step_s > 0.0) faults.push_back(faultOf(name, stamps));
  if (stamps.reconstructed && clocks.empty() && areSorted(samples)) samples = std::move(sorted);
  Samples good;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(good), isMeasurable);
  if (good.size() < samples.size()) {
    const auto found = std::find_if_not(samples.begin(), samples.end(), isMeasurable);
    faults.push_back({name, FaultKind::NotFinite, secondsSince(samples.front().time_ns, found->time_ns),
                      counted(samples.size() - good.size(), "sample", "has", "have") +
                          " values that are not finite, or that no sensor measures."});
  }
  checkTimesOfSensors(name, samples, options, faults);
  const UnfitSamples unfit = findUnfitSamples(good);
  for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis) {
    checkStuck(name, good, kImuAxes[axis], unfit.saturated[axis], options, faults);
    checkSaturated(name, good, kImuAxes[axis], unfit.saturated[axis], faults);
  }
  const Faults held = heldFaults(name, good, unfit);
  faults.insert(faults.end(), held.begin(), held.end());
  checkSpikes(name, good, "gyroscope", measuresRate<ImuSample>, unfit.gyroscope_spikes, faults);
  checkSpikes(name, good, "accelerometer", measuresForce<ImuSample>, unfit.accelerometer_spikes, faults);
  checkUnits(name, good, options, faults);
  return faults;
}

namespace {

const Eigen::Vector3d& forceOf(const ImuSample& sample) {
  return sample.specific_force_m_s2;
}
const Eigen::Vector3d& forceOf(const RawImuSample& sample) {
  return sample.specific_force;
}
const Eigen::Vector3d& rateOf(const ImuSample& sample) {
  return sample.angular_rate_rad_s;
}
const Eigen::Vector3d& rateOf(const RawImuSample& sample) {
  return sample.angular_rate;
}

template <class Sample>
double medianIntervalOf(const std::vector<Sample>& samples) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < samples.size(); ++i)
    intervals_s.push_back(secondsSince(samples[i - 1].time_ns, samples[i].time_ns));
  return medianOf(std::move(intervals_s));
}

template <class Sample>
double medianForceNormOf(const std::vector<Sample>& samples) {
  std::vector<double> norms;
  for (const Sample& sample : samples) {
    const double norm = forceOf(sample).norm();
    if (std::isfinite(norm)) norms.push_back(norm);
  }
  return medianOf(std::move(norms));
}

template <class Sample>
double largestRateOf(const std::vector<Sample>& samples) {
  double largest = 0.0;
  for (const Sample& sample : samples) {
    const double rate = rateOf(sample).cwiseAbs().maxCoeff();
    if (std::isfinite(rate)) largest = std::max(largest, rate);
  }
  return largest;
}

}  // namespace

double medianInterval_s(const std::vector<ImuSample>& samples) {
  return medianIntervalOf(samples);
}

double medianInterval_s(const std::vector<RawImuSample>& samples) {
  return medianIntervalOf(samples);
}

double medianForceNorm(const std::vector<ImuSample>& samples) {
  return medianForceNormOf(samples);
}

double medianForceNorm(const std::vector<RawImuSample>& samples) {
  return medianForceNormOf(samples);
}

std::optional<double> steadyForceNorm(const std::vector<ImuSample>& samples) {
  constexpr double kPiece_s = 2.0, kLongestGap_s = 0.1;
  std::vector<double> norms;
  Eigen::Quaterniond turned =
      Eigen::Quaterniond::Identity();  // first frame of the piece from the current frame
  Eigen::Vector3d sum_m_s = Eigen::Vector3d::Zero();
  double length_s = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double interval_s = secondsSince(samples[i - 1].time_ns, samples[i].time_ns);
    if (interval_s <= 0.0 || interval_s > kLongestGap_s || length_s >= kPiece_s) {
      if (length_s >= kPiece_s) norms.push_back((sum_m_s / length_s).norm());
      turned.setIdentity();
      sum_m_s.setZero();
      length_s = 0.0;
      continue;
    }
    turned = (turned * quaternionExp(interval_s * samples[i].angular_rate_rad_s)).normalized();
    sum_m_s += turned * (interval_s * samples[i].specific_force_m_s2);
    length_s += interval_s;
  }
  if (norms.empty()) return std::nullopt;
  return medianOf(std::move(norms));
}

bool isGravity(double norm_m_s2, const InspectionOptions& options) {
  return std::abs(norm_m_s2 - kStandardGravity_m_s2) <= options.gravity_tolerance_m_s2;
}

double largestRate(const std::vector<ImuSample>& samples) {
  return largestRateOf(samples);
}

double largestRate(const std::vector<RawImuSample>& samples) {
  return largestRateOf(samples);
}

}  // namespace evical
