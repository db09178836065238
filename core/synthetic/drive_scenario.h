// A simulated log of IMUs only: a drive with stops in different attitudes, and IMUs with changes on the way.
// The simulation is determined by these numbers and the seed.
#pragma once

#include "core/synthetic/scenario.h"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// Motion between stops: the rig rotates into the next attitude, and sways and wobbles on the way, by sums of
// sinusoids with a smooth envelope.
struct DriveMotion {
  int stops = 0;          // 0: no stops
  int attitudes = 1;      // attitudes of the stops, in turn
  double tilt_rad = 0.0;  // largest tilt of attitudes relative to the first; pi: all around
  double stop_s = 4.0, drive_s = 6.0;
  Eigen::Vector3d wobble_rad = {0.04, 0.05, 0.08};  // RMS about x, y, z of the reference
  Eigen::Vector3d sway_m = {0.5, 0.5, 0.05};        // RMS along the world's x, y, z
  double lowest_wobble_hz = 0.4, highest_wobble_hz = 2.5;
  double lowest_sway_hz = 0.1, highest_sway_hz = 0.6;

  double cycle_s() const { return stop_s + drive_s; }
};

// Change of an IMU at a moment, added to its previous truth.
struct ImuStep {
  std::size_t imu = 0;
  double at_s = 0.0;
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  // about its own axes
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  double time_offset_s = 0.0;
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_scale = Eigen::Vector3d::Zero();
};

struct DriveScenario {
  std::string name = "drive";
  std::uint64_t seed = 1;
  double duration_s = 120.0;
  std::int64_t start_ns = 1'700'000'000'000'000'000;
  double gravity_m_s2 = 9.81;  // along the world's -z
  DriveMotion motion;
  std::vector<SimulatedImu> imus;  // the first is the reference; values at the time of the calibration
  std::vector<ImuStep> steps;
  double trajectory_hz = 0.0;  // 0: no trajectory is written
  double trajectory_noise_m = 1e-3, trajectory_noise_rad = 1e-4;

  // The IMU with all steps until then.
  SimulatedImu imuAt(std::size_t imu, double time_s) const;
};

// True for a drive scenario; false for a scenario of cameras.
bool isDriveScenario(const std::filesystem::path& path);

// Absent keys keep the defaults; `base:` names a scenario that this one modifies. Throws CalibrationError
// (BadInput).
DriveScenario readDriveScenario(const std::filesystem::path& path);

// The keys of result.yaml with the values at the end, and the steps.
std::string driveTruthYaml(const DriveScenario& scenario);

}  // namespace evical
