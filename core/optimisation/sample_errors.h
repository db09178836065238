// How far the IMU's samples lie from what the state says they should be.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

namespace evical {

// RMS per axis over the samples in the splines' range; 0 without any.
struct SampleErrors {
  double gyroscope_rms_rad_s = 0.0, accelerometer_rms_m_s2 = 0.0;
  int gyroscope_samples = 0, accelerometer_samples = 0;
};
SampleErrors sampleErrors(const CalibrationInput& input, const CalibrationState& state, std::size_t imu);

}  // namespace evical
