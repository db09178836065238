// Small scenarios for tests.
#pragma once

#include "core/synthetic/scenario.h"

namespace evical::test {

// A small sensor without distortion or noise, fronto-parallel to a board of 3x2 circles, without motion.
inline Scenario stillScenario() {
  Scenario scenario;
  scenario.duration_s = 1.0;
  scenario.board.rows = 3;
  scenario.board.cols = 2;
  scenario.scene.clutter_contrast = 0.0;
  scenario.motion = {.distance_m = 0.5,
                     .distance_amplitude_m = 0.0,
                     .angle_amplitude_rad = Eigen::Vector3d::Zero(),
                     .target_amplitude_m = Eigen::Vector2d::Zero(),
                     .image_speed_px_s = 0.0};
  scenario.cameras.resize(1);
  scenario.imus.resize(1);
  SimulatedCamera& camera = scenario.cameras.front();
  camera.intrinsics.resolution_px = {128, 96};
  camera.intrinsics.focal_length_px = {200.0, 200.0};
  camera.intrinsics.principal_point_px = {63.5, 47.5};
  camera.pixel.threshold_mismatch = 0.0;
  camera.pixel.background_rate_hz = 0.0;
  camera.pixel.hot_pixels = 0;
  SimulatedImu& imu = scenario.imus.front();
  imu.gyroscope_density = imu.accelerometer_density = 0.0;
  return scenario;
}

// The same with motion, and a camera that is mounted obliquely on the IMU.
inline Scenario wavedScenario() {
  Scenario scenario = stillScenario();
  scenario.motion = {};
  scenario.motion.distance_m = 0.6;
  scenario.scene.clutter_contrast = 0.5;
  scenario.cameras.front().imu_from_camera.rotation = Eigen::Quaterniond(0.7, 0.1, -0.69, 0.15).normalized();
  scenario.cameras.front().imu_from_camera.translation_m = {0.02, -0.03, 0.05};
  return scenario;
}

}  // namespace evical::test
