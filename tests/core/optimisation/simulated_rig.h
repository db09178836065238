// Observations of a rig with a known truth: sinusoidal motion (not a spline), circles and IMU samples with
// noise.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/optimisation_options.h"

#include <functional>

namespace evical::test {

enum class Motion { Rich, OneAxisRotation, Planar, HardlyMoving };

struct RigOptions {
  double duration_s = 5.0;
  double window_s = 0.02;
  double imu_rate_hz = 400.0;
  double knot_spacing_s = 0.02;
  double centre_sigma_px = 0.05;      // 0: no noise, with the same stated covariance
  double centre_correlation_s = 0.0;  // of that noise, per circle
  double imu_noise = 1.0;             // times the stated densities
  double outlier_share = 0.0;
  Motion motion = Motion::Rich;
  bool second_imu = false;
  double gravity_m_s2 = 9.81;
  double gyroscope_walk = 0.0, accelerometer_walk = 0.0;  // of biases, SI, / sqrt(Hz): Wiener processes
  double gyroscope_turn_rad = 0.0;     // misalignment of every gyroscope with its accelerometer
  double time_offset_drift_ppm = 0.0;  // of all clocks relative to the reference's
  double accelerometer_delay_s = 0.0;  // of every accelerometer relative to its gyroscope
  BoardState board = {};               // relative to the values of the input
  bool frames = false;                 // corners of frames instead of moving circles
  double line_delay_us = 0.0;          // of their rolling shutter
  double exposure_share = 0.0;         // of the additional exposure of longer frames
  bool frames_too = false;             // a second camera: frames of the first one's sensor
  Eigen::Vector3d frames_apart_m = Eigen::Vector3d::Zero();  // from the camera that they are assigned to
  bool further_board = false;  // a second camera that sees another board than the first
  // In units of the default priors: the board's size and stretch, and gravity's norm, random for each seed.
  double scale_spread = 0.0;
  unsigned seed = 1;
};

struct SimulatedRig {
  CalibrationInput input;
  CalibrationState truth;  // splines fitted to the true motion
};
SimulatedRig simulateRig(const RigOptions& options);

// The rig measures circles, not events: pixels cause no delay.
inline OptimisationOptions withoutPixelDelay(OptimisationOptions options = {}) {
  options.pixel_delay_ms = 0.0;
  return options;
}

// For many seeds: 3 s, few samples and views.
inline RigOptions shortRecording(unsigned seed = 1) {
  RigOptions options;
  options.duration_s = 3.0;
  options.imu_rate_hz = 200.0;
  options.window_s = 0.03;
  options.seed = seed;
  return options;
}

// The rig's camera, without distortion, becomes `truth`, with the same focal length and principal point, and
// its circles are seen through another lens, as if found first from the same recording.
void seeThrough(const CameraIntrinsics& truth, const CameraIntrinsics& lens, SimulatedRig& rig);

// The truth, with typical initialisation errors in all estimated quantities.
CalibrationState disturbed(const CalibrationState& truth, unsigned seed, double time_offset_error_s = 0.5e-3);

// Estimate minus truth, in the order and the coordinates of UncertaintyReport::columns (with all quantities
// free that the options allow).
Eigen::VectorXd reportedErrors(const CalibrationState& estimate, const CalibrationState& truth,
                               const OptimisationOptions& options = {});

}  // namespace evical::test
