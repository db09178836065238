// A result prepared for exporters: every sensor with all of its data, the reference IMU first. Texts are
// without control characters.
#pragma once

#include "core/export/export_text.h"

#include "core/data/calibration_state.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"
#include "core/report/result_yaml.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace evical {

struct RigCamera {
  // file_name: the name with letters, digits and -_. only, the first no hyphen: the same in all languages,
  // and no option.
  std::string name, file_name;
  std::string stream;
  CameraKind kind = CameraKind::Events;
  CameraIntrinsics intrinsics;
  RigidTransform reference_from_camera;
  double time_offset_s = 0.0;  // imu_time = camera_time + time_offset_s
  double line_delay_us =
      0.0;  // of a rolling shutter, from row to row; the time offset is that of the middle row
  CameraFit fit;
};

struct RigImu {
  std::string name, file_name, stream;
  ImuNoise noise;        // 0: unknown
  double rate_hz = 0.0;  // 0: unknown
  ImuState state;
};

struct Rig {
  std::string program;              // "Evical 0.1.0"
  std::string status;               // "ok", or "doubtful: reason"
  std::vector<RigCamera> cameras;   // at least one
  std::vector<RigImu> imus;         // the reference first; none in a calibration of cameras only
  std::vector<std::string> timing;  // timingRemarks
  Eigen::Vector3d gravity_m_s2;     // in the board's frame
};

// Remarks for users of the files, collected by all functions below.
using ExportNotes = std::vector<std::string>;

// Throws CalibrationError (BadInput) if a camera has no intrinsics or resolution, or a number is not finite.
Rig rigOf(const NamedResult& result);

// Timing effects that programs do not support: drifting clocks, late accelerometers and rolling shutters, if
// significant.
std::vector<std::string> timingRemarks(const NamedResult& result);

// The reference IMU; throws CalibrationError (BadInput) if there are no IMUs.
const RigImu& neededImu(const Rig& rig, const char* program);

Eigen::Matrix4d matrixOf(const RigidTransform& pose);

// Noise model of the reference IMU, with a note for each number that is not given.
ImuNoise statedNoise(const RigImu& imu, ExportNotes& notes);
double statedRate_hz(const RigImu& imu, ExportNotes& notes);

// Notes on data that a program does not support: an IMU's scales and misalignment, further IMUs, time offsets
// that differ between cameras, cameras beyond the first few.
void noteLostMapping(const RigImu& imu, const char* program, ExportNotes& notes);
void noteLostImus(const Rig& rig, const char* program, ExportNotes& notes);
void noteLostOffsets(const Rig& rig, const char* program, ExportNotes& notes);
void noteNoOffsets(const Rig& rig, const char* program, ExportNotes& notes);  // between cameras
void noteLostCameras(const Rig& rig, std::size_t most, const char* program, ExportNotes& notes);

// For programs without time offsets: the shifts of the images' stamps.
std::string stampShifts(const Rig& rig);

// The first comment of a file: the program and status, the given lines, and remarks on timing.
std::string headerComment(const Rig& rig, const std::vector<std::string>& lines,
                          Language language = Language::Yaml);
// The same as text of a file next to a format without comments.
std::string readMe(const Rig& rig, const std::vector<std::string>& lines);

// IMU scales and misalignment in other programs' conventions. Evical: measured = M true + bias, M of the
// accelerometer upper triangular, which defines the IMU's frame. A lower triangular M in another program
// defines another frame, rotated by `other_from_imu`, and everything in the IMU's frame rotates with it.
struct TriangularTimesRotation {
  Eigen::Matrix3d triangular, rotation;
};

// matrix = lower (or upper) triangular, positive diagonal, times a rotation.
TriangularTimesRotation splitLower(const Eigen::Matrix3d& matrix);
TriangularTimesRotation splitUpper(const Eigen::Matrix3d& matrix);

// Zero residual: measured force = accelerometer * f + bias, measured rate = gyroscope * gyroscope_rotation *
// w + bias, f and w in the frame `other`; both matrices lower triangular.
struct LowerTriangularImu {
  Eigen::Matrix3d other_from_imu = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d accelerometer = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d gyroscope = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d gyroscope_rotation = Eigen::Matrix3d::Identity();
};
LowerTriangularImu lowerTriangular(const ImuState& imu);

bool hasMapping(const ImuState& imu);  // true unless both matrices are the identity

// p_other = ... * p_imu, as a rigid transform without translation.
RigidTransform turnOf(const Eigen::Matrix3d& other_from_imu);

}  // namespace evical
