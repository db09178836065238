// Errors of an IMU's samples, measured against their prediction from the state.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/data/unfit_samples.h"
#include "core/geometry/spline_segment.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace evical {

// RMS per axis over the samples in the batch (sample_errors.h); 0 without any.
struct SampleErrors {
  double gyroscope_rms_rad_s = 0.0, accelerometer_rms_m_s2 = 0.0;
  int gyroscope_samples = 0, accelerometer_samples = 0;
  // Norm of each sample's error; NaN for the others.
  std::vector<double> gyroscope_rad_s, accelerometer_m_s2;
};
SampleErrors sampleErrors(const CalibrationInput& input, const CalibrationState& state, std::size_t imu);

// Excludes isolated samples that contradict the state (docs/maths.md, 9.3): their errors exceed
// `outlier_sigma` both of the sensor's usual errors and of those of their neighbours. If a spline cannot
// follow a motion, all errors nearby are large, and the samples stay.
SampleSelection selectSamples(const SampleErrors& errors, const SampleSelection& fit, double outlier_sigma);

// A sentence for each of the IMU's sensors with unused fit samples: their number and times.
std::vector<std::string> notesOfUnused(const CalibrationInput& input, std::size_t imu,
                                       const SampleSelection& used);

// RMS per axis of the used samples; 0 without any.
double rmsPerAxis(const std::vector<double>& norms, const std::vector<std::uint8_t>& used);

// Gyroscope or accelerometer samples that share spline segments and bias knots: one block of the batch each.
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
