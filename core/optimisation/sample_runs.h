// Samples of a gyroscope or an accelerometer that share spline segments and the knots of its biases: one block of the
// batch each.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/spline_segment.h"

#include <cstddef>
#include <vector>

namespace evical {

struct SampleRun {
  std::size_t imu;
  SegmentTimes segment;
  double stamp_s;          // of the first, on the IMU's own clock
  double time_s, last_s;   // when it and the last one were measured, on the reference's
  std::size_t begin, end;  // of the IMU's samples
};

// Of the samples that lie within the splines. Of an accelerometer without those that begin late in a segment or end
// early, as where a delay has carried a few across a border: its outermost control points would rest on next to nothing,
// and say as little of these samples.
std::vector<SampleRun> gyroscopeRuns(const CalibrationInput& input, const CalibrationState& state,
                                     std::size_t imu);
std::vector<SampleRun> accelerometerRuns(const CalibrationInput& input, const CalibrationState& state,
                                         std::size_t imu);

}  // namespace evical
