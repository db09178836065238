// A calibration as another program reads it from its own files, in our terms. Readers (readers.h) are written from the
// other program's source: the keys that it demands, the types, lengths and shapes that it insists on, its directions and
// signs. What it would not take is a CalibrationError (BadInput) that names file and key.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// What a file says of a camera; what it has no place for stays empty.
struct ReadCamera {
  // By which the file knows it: the camera's name, its name in files or its stream. Empty: cameras come in the result's
  // order.
  std::string name = {};
  std::optional<CameraIntrinsics> lens = {};             // resolution 0: the program asks for none here
  std::optional<RigidTransform> frame_from_camera = {};  // see ReadFile::about_first_camera
  std::optional<double> time_offset_s = {};              // t_reference = t_camera + that
};

// What a file says of an IMU. measured = M true + bias, in the frame that the file gives the IMU: turned against ours
// where the program wants M of another shape.
struct ReadImu {
  std::string name = {};                                              // as ReadCamera::name
  std::optional<RigidTransform> reference_from_imu = {};              // both frames as the files have them
  std::optional<double> time_offset_s = {};                           // t_reference = t_imu + that
  std::optional<Eigen::Matrix3d> accelerometer = {}, gyroscope = {};  // M
  std::optional<Eigen::Vector3d> accelerometer_bias_m_s2 = {}, gyroscope_bias_rad_s = {};
  std::optional<ImuNoise> noise = {};
  bool noise_of_samples = false;  // not densities: those times the square root of the rate
  std::optional<double> rate_hz = {};
};

struct ReadFile {
  std::filesystem::path path = {};
  std::vector<ReadCamera> cameras = {};
  std::vector<ReadImu> imus = {};   // the reference first, where they have no names
  bool about_first_camera = false;  // poses: in the frame of the first of `cameras`, else the reference IMU's
  double rounding = 1e-12;          // relative, of numbers as the program keeps them
  double time_step_s = 0.0;         // of its time offsets
  std::optional<double> gravity_m_s2 = {};  // how large
};

// Relative rounding of a program that keeps its numbers as float.
inline constexpr double kFloatRounding = 6e-8;

struct ReadBack {
  static constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  std::vector<ReadFile> files = {};
  std::size_t most_cameras = kAny, most_imus = kAny;  // that the program takes
};

}  // namespace evical
