#include "core/optimisation/sample_runs.h"

#include "core/base/time.h"
#include "core/optimisation/bias_knots.h"

#include <cstdlib>

namespace evical {
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
  constexpr double kLeastShare = 0.5;  // of the segment
  std::vector<SampleRun> kept;
  const auto nextTo = [&](std::size_t i, std::size_t other) {
    return other < runs.size() && std::abs(runs[i].segment.position - runs[other].segment.position) <= 1;
  };
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool whole = runs[i].last_s - runs[i].time_s >= kLeastShare * runs[i].segment.position_spacing_s;
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
