// How far the IMU's samples lie from what the state says they should be.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/data/unfit_samples.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

// RMS per axis over the samples that the batch has blocks for (sample_runs.h); 0 without any.
struct SampleErrors {
  double gyroscope_rms_rad_s = 0.0, accelerometer_rms_m_s2 = 0.0;
  int gyroscope_samples = 0, accelerometer_samples = 0;
  // Norm of each sample's error; NaN of the others.
  std::vector<double> gyroscope_rad_s, accelerometer_m_s2;
};
SampleErrors sampleErrors(const CalibrationInput& input, const CalibrationState& state, std::size_t imu);

// Of those that are fit, leaves out samples that stand alone in contradicting the state (docs/maths.md, 9.3):
// their errors are beyond `outlier_sigma` both of the sensor's usual ones and of those beside them. Where a
// spline cannot follow a motion, errors are large in company, and stay.
SampleSelection selectSamples(const SampleErrors& errors, const SampleSelection& fit, double outlier_sigma);

// A sentence about each of the IMU's sensors of which fit samples are not used: how many, and when.
std::vector<std::string> notesOfUnused(const CalibrationInput& input, std::size_t imu,
                                       const SampleSelection& used);

// RMS per axis of those that are used; 0 without any.
double rmsPerAxis(const std::vector<double>& norms, const std::vector<std::uint8_t>& used);

}  // namespace evical
