// Exported files as the programs they are for take them, in our terms, and how far that is from the result. Readers
// (read_back/readers.h) are written from the other program's source: the keys that it demands, the types, lengths and
// shapes that it insists on, its directions and signs. What it would not take is a CalibrationError (BadInput) that names
// file and key.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"
#include "core/report/export/export_target.h"
#include "core/report/export/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
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
  std::optional<StatedNoise> noise = {};
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

// The largest differences of what was read from the result; those of which nothing was read are empty.
struct ReadBackDifference {
  std::size_t cameras = 0, imus = 0;
  std::optional<double> lens_px = {};  // of the same ray, over the image
  std::optional<double> rotation_deg = {}, translation_mm = {}, time_ms = {};
  std::optional<double> numbers = {};  // relative, of scales, biases, noise, rates and gravity
  std::optional<double>
      refitted_px;  // of lenses that the program has no place for; as far as their refit is off
  std::vector<std::string>
      problems;  // more than rounding explains, or sensors that are nowhere; each names the file
};

// Sensors that the result does not have are left aside where the file names them.
ReadBackDifference differenceOf(const NamedResult& result, const ReadBack& read);

struct ExportCheck {
  bool same = false;
  std::string text;  // one line for people: "kalibr: reads back: ..."
};

// Of the files below folder / target.name.
ExportCheck checkExport(const NamedResult& result, const ExportTarget& target,
                        const std::filesystem::path& folder);

}  // namespace evical
