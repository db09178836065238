// A calibration as another program reads it from its own files, in Evical's terms. Readers (readers.h) follow
// the other program's source: the keys, types, lengths and shapes that it requires, its directions and signs.
// Anything that it would refuse is a CalibrationError (BadInput) that names file and key.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// A file's data of a camera; empty if the format has no place for them.
struct ReadCamera {
  // The camera's name in the file: its name, its name in files or its stream. Empty: cameras are in the
  // result's order.
  std::string name = {};
  std::optional<CameraIntrinsics> lens = {};             // resolution 0: not required here
  std::optional<RigidTransform> frame_from_camera = {};  // see ReadFile::about_first_camera
  std::optional<double> time_offset_s = {};              // t_reference = t_camera + that
};

// A file's data of an IMU. measured = M true + bias, in the file's frame of the IMU, which is rotated
// relative to Evical's if the program requires another shape of M.
struct ReadImu {
  std::string name = {};                                              // as ReadCamera::name
  std::optional<RigidTransform> reference_from_imu = {};              // both frames as in the files
  std::optional<double> time_offset_s = {};                           // t_reference = t_imu + that
  std::optional<Eigen::Matrix3d> accelerometer = {}, gyroscope = {};  // M
  std::optional<Eigen::Vector3d> accelerometer_bias_m_s2 = {}, gyroscope_bias_rad_s = {};
  std::optional<ImuNoise> noise = {};
  bool noise_of_samples = false;  // densities times the square root of the rate
  std::optional<double> rate_hz = {};
};

struct ReadFile {
  std::filesystem::path path = {};
  std::vector<ReadCamera> cameras = {};
  std::vector<ReadImu> imus = {};  // the reference first, if they have no names
  bool about_first_camera =
      false;                 // poses: in the frame of the first of `cameras`, otherwise of the reference IMU
  double rounding = 1e-12;   // relative, of the program's number type
  double time_step_s = 0.0;  // of its time offsets
  std::optional<double> gravity_m_s2 = {};  // norm
};

// Relative rounding of a program that stores numbers as float.
inline constexpr double kFloatRounding = 6e-8;

struct ReadBack {
  static constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  std::vector<ReadFile> files = {};
  std::size_t max_cameras = kAny, max_imus = kAny;  // that the program accepts
};

}  // namespace evical
