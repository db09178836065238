#include "core/base/time.h"
#include "core/recording/imu_statistics.h"
#include "core/recording/inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr std::size_t kMostAlikeFaults = 10;
constexpr double kGravity_m_s2 = 9.80665;
constexpr std::int64_t kClockReset_ns = 1'000'000'000;

using Faults = std::vector<RecordingFault>;
using Samples = std::vector<ImuSample>;

// Lists the first few of many alike, and says how many there are.
void appendFaults(Faults& faults, Faults alike, const char* many) {
  if (alike.size() > kMostAlikeFaults) {
    RecordingFault rest = alike[kMostAlikeFaults];
    rest.text = fmt::format("{} more {}.", alike.size() - kMostAlikeFaults, many);
    alike.resize(kMostAlikeFaults);
    alike.push_back(rest);
  }
  faults.insert(faults.end(), alike.begin(), alike.end());
}

void checkTimes(const std::string& name, const Samples& samples, const InspectionOptions& options,
                Faults& faults) {
  const double period_s = medianInterval_s(samples);
  Faults gaps, backward;
  double square_sum_s2 = 0.0;
  std::size_t regular = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double at_s = secondsSince(samples.front().time_ns, samples[i - 1].time_ns);
    const double interval_s = secondsSince(samples[i - 1].time_ns, samples[i].time_ns);
    if (interval_s < 0.0) {
      const char* reset =
          samples[i - 1].time_ns - samples[i].time_ns > kClockReset_ns ? "; the clock was reset" : "";
      backward.push_back(
          {name, FaultKind::BackwardTime, at_s,
           fmt::format("Time runs backwards by {:.3f} ms at sample {}{}.", -1e3 * interval_s, i, reset)});
    } else if (interval_s > options.imu_gap_periods * period_s && period_s > 0.0) {
      gaps.push_back({name, FaultKind::Gap, at_s,
                      fmt::format("No samples for {:.3f} ms, where {:.3f} ms are usual.", 1e3 * interval_s,
                                  1e3 * period_s)});
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
         fmt::format("The intervals of samples scatter by {:.3f} ms about {:.3f} ms: were they stamped when "
                     "they arrived?",
                     1e3 * jitter_s, 1e3 * period_s)});
  }
}

struct Axis {
  const char* name;
  bool rate;  // else specific force
  int index;
};
constexpr Axis kAxes[] = {{"angular rate x", true, 0},    {"angular rate y", true, 1},
                          {"angular rate z", true, 2},    {"specific force x", false, 0},
                          {"specific force y", false, 1}, {"specific force z", false, 2}};

double valueOf(const ImuSample& sample, const Axis& axis) {
  return (axis.rate ? sample.angular_rate_rad_s : sample.specific_force_m_s2)[axis.index];
}

void checkAxis(const std::string& name, const Samples& samples, const Axis& axis,
               const InspectionOptions& options, Faults& faults) {
  double largest = 0.0;
  for (const ImuSample& sample : samples) largest = std::max(largest, std::abs(valueOf(sample, axis)));
  const bool may_saturate =
      largest >= (axis.rate ? options.saturated_from_rad_s : options.saturated_from_m_s2);
  std::size_t saturated = 0;
  double saturated_at_s = 0.0;
  Faults stuck;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    const double value = valueOf(samples[begin], axis);
    for (end = begin + 1; end < samples.size() && valueOf(samples[end], axis) == value;) ++end;
    const double at_s = secondsSince(samples.front().time_ns, samples[begin].time_ns);
    const double run_s = secondsSince(samples[begin].time_ns, samples[end - 1].time_ns);
    if (may_saturate && std::abs(value) == largest &&
        end - begin >= static_cast<std::size_t>(options.saturated_run_samples)) {
      if (saturated == 0) saturated_at_s = at_s;
      saturated += end - begin;
    } else if (run_s >= options.stuck_axis_s) {
      stuck.push_back({name, FaultKind::StuckAxis, at_s,
                       fmt::format("{} stays at {} for {:.2f} s.", axis.name, value, run_s)});
    }
  }
  appendFaults(faults, std::move(stuck), "such times");
  if (saturated == 0) return;
  faults.push_back(
      {name, FaultKind::SaturatedAxis, saturated_at_s,
       fmt::format("{} is at its limit of {:.4g} for {} samples: move less fast, or widen the IMU's range.",
                   axis.name, largest, saturated)});
}

void checkUnits(const std::string& name, const Samples& samples, const InspectionOptions& options,
                Faults& faults) {
  const double norm = medianForceNorm(samples);
  if (std::abs(norm - kGravity_m_s2) > options.gravity_tolerance_m_s2) {
    const bool in_g = std::abs(norm * kGravity_m_s2 - kGravity_m_s2) <= options.gravity_tolerance_m_s2;
    faults.push_back(
        {name, FaultKind::Unit, 0.0,
         fmt::format("The median norm of the specific force is {:.3f}, not 9.8 m/s^2{}.", norm,
                     in_g ? ": the file has it in g" : "; is gravity removed, or the unit another?")});
  }
  const double fastest = largestRate(samples);
  if (fastest > options.largest_rate_rad_s) {
    faults.push_back(
        {name, FaultKind::Unit, 0.0,
         fmt::format("The angular rate reaches {:.1f}: too fast for rad/s, probably deg/s.", fastest)});
  }
}

}  // namespace

std::vector<RecordingFault> checkImu(const std::string& name, const std::vector<ImuSample>& samples,
                                     const InspectionOptions& options) {
  Faults faults;
  if (samples.size() < 2) {
    faults.push_back(
        {name, FaultKind::Empty, 0.0, fmt::format("The stream has {} IMU samples.", samples.size())});
    return faults;
  }
  const auto broken = [](const ImuSample& s) {
    return !s.angular_rate_rad_s.allFinite() || !s.specific_force_m_s2.allFinite();
  };
  const auto found = std::find_if(samples.begin(), samples.end(), broken);
  if (found != samples.end()) {
    faults.push_back({name, FaultKind::NotFinite, secondsSince(samples.front().time_ns, found->time_ns),
                      fmt::format("{} samples hold values that are no numbers.",
                                  std::count_if(samples.begin(), samples.end(), broken))});
  }
  checkTimes(name, samples, options, faults);
  for (const Axis& axis : kAxes) checkAxis(name, samples, axis, options, faults);
  checkUnits(name, samples, options, faults);
  return faults;
}

}  // namespace evical
