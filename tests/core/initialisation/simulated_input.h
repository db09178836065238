// Calibration inputs with a known truth: synthetic motion, circles and IMU samples, without events.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/synthetic/scenario.h"

namespace evical::test {

enum class Motion { Everyday, Slow, Fast, OneAxis, Planar, HardlyMoving, Periodic, Symmetric, Shaky };

struct SimulationOptions {
  double duration_s = 30.0;
  double time_offset_s = 0.01;
  double imu_rate_hz = 1000.0;
  double window_s = 0.02;
  double centre_sigma_px = 0.15;
  double missing_share = 0.0;    // share of the windows: half of them individually, half in stretches of 1 s
  double misplaced_share = 0.0;  // share of the views whose circles are numbered one row too far
  Motion motion = Motion::Everyday;
  double distance_m = 0.68;
  int cameras = 1;
  bool second_imu = false;
  double second_imu_offset_s = 0.03;  // reference_time = its time + offset
  // Views are simulated for camera times from 0 to the duration, IMU samples for IMU times in the same range.
  double imu_begin_s = 0.0, imu_end_s = -1.0;  // truncated, on the IMU's clock; -1: complete
  std::uint64_t seed = 1;
};

struct SimulatedInput {
  Scenario truth;
  CalibrationInput input;
  int misplaced = 0;
};
SimulatedInput simulateInput(const SimulationOptions& options);

// Errors after initialisation, against the truth.
struct InitialErrors {
  double rotation_deg = 0.0, translation_m = 0.0, time_offset_s = 0.0, gravity_deg = 0.0;
  double gyroscope_bias_rad_s = 0.0, accelerometer_bias_m_s2 = 0.0;
  double trajectory_rotation_deg = 0.0, trajectory_position_m = 0.0;  // RMS during board views
};
InitialErrors initialErrors(const CalibrationState& state, const SimulatedInput& simulated,
                            std::size_t camera = 0);

}  // namespace evical::test
