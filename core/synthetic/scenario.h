// A simulated recording in numbers: board, sensors, motion, noise, seed. Everything that
// is simulated follows from it.
#pragma once

#include "core/data/calibration_state.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/circle_board.h"
#include "core/geometry/rigid_transform.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace evical {

// An event pixel: log intensity, low-pass filtered, compared with the level at its last event.
struct EventPixelModel {
  double threshold_on = 0.3, threshold_off = 0.3;  // log intensity
  double threshold_mismatch = 0.03;                // sigma over pixels, relative
  double refractory_s = 1e-4;
  double background_rate_hz = 0.1;  // per pixel, either polarity
  int hot_pixels = 5;
  double hot_pixel_rate_hz = 500.0;
  double blur_px = 0.6;         // sigma of the optics' point spread; the pixel's area comes on top
  double latency_s = 2e-4;      // pure delay
  double low_pass_s = 3e-4;     // time constant of the photoreceptor
  double stamp_jitter_s = 0.0;  // stamps are late by the absolute value of a normal variable with this sigma

  // By how much an event's stamp is late for a slow edge: latency, the low-pass filter's group
  // delay, and the jitter's mean.
  double delay_s() const {
    constexpr double kMeanOfHalfNormal = 0.7978845608028654;  // sqrt(2 / pi)
    return latency_s + low_pass_s + kMeanOfHalfNormal * stamp_jitter_s;
  }
};

struct SimulatedCamera {
  std::string name = "camera";
  std::string stream = "/camera/events";
  CameraIntrinsics intrinsics;
  RigidTransform imu_from_camera;
  double time_offset_s = 0.0;  // imu_time = camera_time + offset, of the clocks alone
  EventPixelModel pixel;
};

// What is true of an IMU, and how it measures. Biases are those at the start where they walk.
struct SimulatedImu : ImuState {
  std::string name = "imu";
  std::string stream = "/imu";
  double rate_hz = 1000.0;
  double gyroscope_density = 1.87e-4;      // rad/s/sqrt(Hz)
  double accelerometer_density = 1.86e-3;  // m/s^2/sqrt(Hz)
  double gyroscope_walk = 0.0;             // rad/s^2/sqrt(Hz)
  double accelerometer_walk = 0.0;         // m/s^3/sqrt(Hz)
};

// The first camera looks at a point that wanders around the board's middle, from a distance and along a
// direction that wander too. Each of these quantities is a sum of sinusoids drawn from the seed. On top, it
// may turn to and fro about its own y axis, evenly, where it stands: other cameras of a rig then see the
// board in its place.
struct MotionModel {
  double distance_m = 0.55;
  double distance_amplitude_m = 0.08;
  Eigen::Vector3d angle_amplitude_rad = {0.35, 0.35, 0.3};  // about the camera's x, y, z
  Eigen::Vector2d target_amplitude_m = {0.04, 0.04};
  double roll_rad = 0.0;  // of the camera, on average
  double turn_rad = 0.0;  // about its y axis, on average
  double turn_amplitude_rad = 0.0;
  double turn_period_s = 4.0;
  double lowest_frequency_hz = 0.3;  // before scaling to the speed
  double highest_frequency_hz = 1.2;
  int sinusoids = 3;
  double image_speed_px_s =
      70.0;  // RMS over circles and time: frequencies are scaled to reach it; 0 keeps them
};

struct SceneModel {
  double bright_reflectance = 0.85, dark_reflectance = 0.06;
  double margin_m = 0.06;             // of the board around its outer circles' centres
  double clutter_contrast = 0.5;      // sigma of the background's log reflectance; 0: bare
  double clutter_distance_m = 0.3;    // behind the board
  double clutter_object_share = 0.5;  // of the variance: flat objects with outlines; the rest is clouds
  double clutter_detail_px = 2.0;     // smallest structure, at the mean distance
};

enum class SimulatedFormat { Bag, Text };

struct Scenario {
  std::string name = "scenario";
  std::uint64_t seed = 1;
  double duration_s = 30.0;
  std::int64_t start_ns = 1'700'000'000'000'000'000;
  CircleBoard board;
  SceneModel scene;
  MotionModel motion;
  Eigen::Vector3d gravity_in_world_m_s2 = {0.0, 9.81, 0.0};  // the board hangs upright: y points down
  std::vector<SimulatedCamera> cameras;
  std::vector<SimulatedImu> imus;  // the first is the reference
  SimulatedFormat format = SimulatedFormat::Bag;
  bool intrinsics_in_session = true;
};

}  // namespace evical
