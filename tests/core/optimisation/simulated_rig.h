// Observations of a rig whose truth is known: motion by sinusoids (no spline in it), circles
// and IMU samples with noise.
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
  double centre_sigma_px = 0.05;      // 0: no noise, while the stated covariance stays
  double centre_correlation_s = 0.0;  // of that noise, per circle
  double imu_noise = 1.0;             // times the stated densities
  double outlier_share = 0.0;
  Motion motion = Motion::Rich;
  bool second_imu = false;
  double gravity_m_s2 = 9.81;
  double gyroscope_walk = 0.0, accelerometer_walk = 0.0;  // of biases, SI, / sqrt(Hz): Wiener processes
  double gyroscope_turn_rad = 0.0;                        // of every gyroscope against its accelerometer
  double time_offset_drift_ppm = 0.0;                     // of all clocks against the reference's
  double accelerometer_delay_s = 0.0;                     // of every accelerometer against its gyroscope
  BoardState board = {};                                  // against what the input says of it
  bool frames = false;                                    // corners of frames in the place of moving circles
  double line_delay_us = 0.0;                             // of their rolling shutter
  double exposure_share = 0.0;                            // of what frames are exposed longer than others
  bool frames_too = false;                                // a second camera: frames of the first one's sensor
  Eigen::Vector3d frames_apart_m = Eigen::Vector3d::Zero();  // which they are said to be of, and are not
  bool further_board = false;  // a second camera, that sees another board than the first
  // Times the default priors: the board's size and stretch, and gravity's norm, drawn anew for each seed.
  double scale_spread = 0.0;
  unsigned seed = 1;
};

struct SimulatedRig {
  CalibrationInput input;
  CalibrationState truth;  // splines fitted to the true motion
};
SimulatedRig simulateRig(const RigOptions& options);

// The rig measures circles, not events: no pixel delays them.
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

// The rig's camera, which has no distortion, becomes `truth`, of the same focal length and principal point,
// and is seen through another lens, as found first from the same recording.
void seeThrough(const CameraIntrinsics& truth, const CameraIntrinsics& lens, SimulatedRig& rig);

// The truth, with everything that initialisation estimates off by about what it leaves.
CalibrationState disturbed(const CalibrationState& truth, unsigned seed, double time_offset_error_s = 0.5e-3);

// Estimate minus truth, in the order and the coordinates of UncertaintyReport::columns (all quantities
// released that the options allow).
Eigen::VectorXd reportedErrors(const CalibrationState& estimate, const CalibrationState& truth,
                               const OptimisationOptions& options = {});

}  // namespace evical::test
