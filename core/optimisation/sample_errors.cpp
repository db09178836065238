#include "core/optimisation/sample_errors.h"

#include "core/optimisation/bias_knots.h"

#include "core/base/time.h"
#include "core/data/imu_prediction.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace evical {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kMedianOfChi2With3 = 2.3659738843753377;
constexpr std::size_t kNeighbours = 16;  // on either side

// Sigma per axis of errors with these norms.
double scaleOfNorms(std::vector<double> norms) {
  return medianOf(std::move(norms)) / std::sqrt(kMedianOfChi2With3);
}

struct Range {
  std::size_t begin, end;
};

// Range around `i` with `kNeighbours` fit samples on either side.
Range neighboursOf(std::size_t i, const std::vector<std::uint8_t>& fit) {
  Range range{i, i + 1};
  for (std::size_t left = kNeighbours; left > 0 && range.begin > 0;) left -= fit[--range.begin] ? 1 : 0;
  for (std::size_t left = kNeighbours; left > 0 && range.end < fit.size();) left -= fit[range.end++] ? 1 : 0;
  return range;
}

// Norms of the fit samples in a range, without one of them.
std::vector<double> normsIn(Range range, const std::vector<double>& norms,
                            const std::vector<std::uint8_t>& fit, std::size_t without) {
  std::vector<double> found;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (i != without && fit[i] && !std::isnan(norms[i])) found.push_back(norms[i]);
  }
  return found;
}

std::vector<std::uint8_t> select(const std::vector<double>& norms, const std::vector<std::uint8_t>& fit,
                                 double outlier_sigma) {
  const double usual = scaleOfNorms(normsIn({0, norms.size()}, norms, fit, norms.size()));
  std::vector<std::uint8_t> used = fit;
  for (std::size_t i = 0; i < norms.size(); ++i) {
    if (!fit[i] || !(norms[i] > outlier_sigma * usual)) continue;
    if (norms[i] > outlier_sigma * scaleOfNorms(normsIn(neighboursOf(i, fit), norms, fit, i))) used[i] = 0;
  }
  return used;
}

}  // namespace

double rmsPerAxis(const std::vector<double>& norms, const std::vector<std::uint8_t>& used) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < norms.size(); ++i) {
    if (!used[i] || std::isnan(norms[i])) continue;
    sum += norms[i] * norms[i];
    ++count;
  }
  return count > 0 ? std::sqrt(sum / (3.0 * count)) : 0.0;
}

SampleSelection selectSamples(const SampleErrors& errors, const SampleSelection& fit, double outlier_sigma) {
  return {select(errors.gyroscope_rad_s, fit.gyroscope, outlier_sigma),
          select(errors.accelerometer_m_s2, fit.accelerometer, outlier_sigma)};
}

std::vector<std::string> notesOfUnused(const CalibrationInput& input, std::size_t imu,
                                       const SampleSelection& used) {
  constexpr std::size_t kMaxTimes = 5;
  const ImuData& data = input.imus[imu];
  std::vector<std::string> notes;
  const SampleSelection fit = fitSamples(data.samples);
  const auto say = [&](const char* sensor, const std::vector<std::uint8_t>& could,
                       const std::vector<std::uint8_t>& taken) {
    std::string times;
    std::size_t count = 0;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (taken[i] || !could[i]) continue;
      if (count++ < kMaxTimes)
        times += fmt::format("{}{:.3f} s", count > 1 ? ", " : "",
                             secondsSince(input.start_ns, data.samples[i].time_ns));
    }
    if (count == 0) return;
    notes.push_back(fmt::format(
        "{}: {} of {} samples of the {} contradict the motion (at {}{}) and were excluded", data.name, count,
        std::count(could.begin(), could.end(), 1), sensor, times, count > kMaxTimes ? ", ..." : ""));
  };
  say("gyroscope", fit.gyroscope, used.gyroscope);
  say("accelerometer", fit.accelerometer, used.accelerometer);
  return notes;
}

SampleErrors sampleErrors(const CalibrationInput& input, const CalibrationState& state, std::size_t imu) {
  const ImuState& imu_state = state.imus[imu];
  SampleErrors errors;
  for (const ImuSample& sample : input.imus[imu].samples) {
    double& rate_error = errors.gyroscope_rad_s.emplace_back(kNone);
    errors.accelerometer_m_s2.push_back(kNone);
    const double stamp_s = secondsSince(input.start_ns, sample.time_ns);
    if (!measuresRate(sample)) continue;
    const auto rate = predictedRate_rad_s(state, imu_state, stamp_s);
    if (!rate) continue;
    rate_error = (*rate - sample.angular_rate_rad_s).norm();
    ++errors.gyroscope_samples;
  }
  for (const SampleRun& run : accelerometerRuns(input, state, imu)) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const ImuSample& sample = input.imus[imu].samples[i];
      if (!measuresForce(sample)) continue;
      const auto force = predictedForce_m_s2(state, imu_state, secondsSince(input.start_ns, sample.time_ns));
      if (!force) continue;
      errors.accelerometer_m_s2[i] = (*force - sample.specific_force_m_s2).norm();
      ++errors.accelerometer_samples;
    }
  }
  const std::vector<std::uint8_t> all(errors.gyroscope_rad_s.size(), 1);
  errors.gyroscope_rms_rad_s = rmsPerAxis(errors.gyroscope_rad_s, all);
  errors.accelerometer_rms_m_s2 = rmsPerAxis(errors.accelerometer_m_s2, all);
  return errors;
}

namespace {

// `timeOf` converts a stamp to the time of measurement; `within` checks whether the splines cover it.
template <class TimeOf, class Within>
std::vector<SampleRun> runsOf(const CalibrationInput& input, const CalibrationState& all, std::size_t imu,
                              TimeOf&& timeOf, Within&& within) {
  const ImuState& state = all.imus[imu];
  const auto& samples = input.imus[imu].samples;
  std::vector<SampleRun> runs;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double stamp_s = secondsSince(input.start_ns, samples[i].time_ns);
    const double time_s = timeOf(state, stamp_s);
    if (!within(time_s)) continue;
    const SegmentTimes segment = segmentAt(all.world_from_imu_rotation, all.imu_in_world_m, time_s);
    if (runs.empty() || runs.back().end != i || !sameSegment(segment, runs.back().segment) ||
        !sameBiasKnots(state, stamp_s, runs.back().stamp_s))
      runs.push_back({imu, segment, stamp_s, time_s, time_s, i, i});
    runs.back().end = i + 1;
    runs.back().last_s = time_s;
  }
  return runs;
}

std::vector<SampleRun> withoutStumps(const std::vector<SampleRun>& runs) {
  constexpr double kMinShare = 0.5;  // of the segment
  std::vector<SampleRun> kept;
  const auto nextTo = [&](std::size_t i, std::size_t other) {
    return other < runs.size() && std::abs(runs[i].segment.position - runs[other].segment.position) <= 1;
  };
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool whole = runs[i].last_s - runs[i].time_s >= kMinShare * runs[i].segment.position_spacing_s;
    if (whole || (i > 0 && nextTo(i, i - 1) && nextTo(i, i + 1))) kept.push_back(runs[i]);
  }
  return kept;
}

}  // namespace

std::vector<SampleRun> gyroscopeRuns(const CalibrationInput& input, const CalibrationState& state,
                                     std::size_t imu) {
  return runsOf(input, state, imu, referenceTime_s<ImuState>,
                [&](double time_s) { return state.world_from_imu_rotation.contains(time_s); });
}

std::vector<SampleRun> accelerometerRuns(const CalibrationInput& input, const CalibrationState& state,
                                         std::size_t imu) {
  return withoutStumps(runsOf(input, state, imu, accelerometerTime_s, [&](double time_s) {
    return state.world_from_imu_rotation.contains(time_s) && state.imu_in_world_m.contains(time_s);
  }));
}

}  // namespace evical
