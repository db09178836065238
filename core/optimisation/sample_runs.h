// Gyroscope or accelerometer samples that share spline segments and bias knots: one block of the batch each.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/geometry/spline_segment.h"

#include <cstddef>
#include <vector>

namespace evical {

struct SampleRun {
  std::size_t imu;
  SegmentTimes segment;
  double stamp_s;          // first sample, on the IMU's own clock
  double time_s, last_s;   // times of the first and last sample, on the reference's
  std::size_t begin, end;  // of the IMU's samples
};

// Runs of the samples within the splines. An accelerometer's outermost runs are dropped if they begin late in
// a segment or end early, as when a delay moves a few samples across a border: they would hardly constrain
// its outermost control points, and these hardly the samples.
std::vector<SampleRun> gyroscopeRuns(const CalibrationInput& input, const CalibrationState& state,
                                     std::size_t imu);
std::vector<SampleRun> accelerometerRuns(const CalibrationInput& input, const CalibrationState& state,
                                         std::size_t imu);

}  // namespace evical
