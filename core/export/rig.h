// A result as exporters want it: every sensor with all that is known of it, the reference IMU first.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"
#include "core/report/result_yaml.h"

#include <optional>
#include <string>
#include <vector>

namespace evical {

struct RigCamera {
  std::string name, file_name;  // file_name: the name with nothing but letters, digits and -_.
  std::string stream;
  CameraKind kind = CameraKind::Events;
  CameraIntrinsics intrinsics;
  RigidTransform reference_from_camera;
  double time_offset_s = 0.0;  // imu_time = camera_time + time_offset_s
  double line_delay_us =
      0.0;  // of a rolling shutter, from row to row; the time offset is that of the middle one
  CameraFit fit;
};

struct RigImu {
  std::string name, file_name, stream;
  ImuNoise noise;        // 0: not known
  double rate_hz = 0.0;  // 0: not known
  ImuState state;
};

struct Rig {
  std::string program;              // "Evical 0.1.0"
  std::string status;               // "ok", or "doubtful: why"
  std::vector<RigCamera> cameras;   // at least one
  std::vector<RigImu> imus;         // the reference first; none in a calibration of cameras only
  std::vector<std::string> timing;  // timingRemarks
  Eigen::Vector3d gravity_m_s2;     // in the board's frame
};

// What to know before using the files: appended to by all that find something.
using ExportNotes = std::vector<std::string>;

// Throws CalibrationError (BadInput) where a camera has no intrinsics or resolution, or a number is none.
Rig rigOf(const NamedResult& result);

// What programs have no place for: clocks that drift, accelerometers that are late and shutters that roll, more than by
// chance.
std::vector<std::string> timingRemarks(const NamedResult& result);

// The reference IMU; throws CalibrationError (BadInput) where there is none.
const RigImu& neededImu(const Rig& rig, const char* program);

Eigen::Matrix4d matrixOf(const RigidTransform& pose);

// What the noise model of the reference IMU is, with a note for each number that nobody has given.
ImuNoise statedNoise(const RigImu& imu, ExportNotes& notes);
double statedRate_hz(const RigImu& imu, ExportNotes& notes);

// Notes on what a program has no place for: an IMU's scales and misalignment, further IMUs, time offsets that
// differ from camera to camera, cameras beyond the first few.
void noteLostMapping(const RigImu& imu, const char* program, ExportNotes& notes);
void noteLostImus(const Rig& rig, const char* program, ExportNotes& notes);
void noteLostOffsets(const Rig& rig, const char* program, ExportNotes& notes);
void noteNoOffsets(const Rig& rig, const char* program, ExportNotes& notes);  // of cameras among each other
void noteLostCameras(const Rig& rig, std::size_t most, const char* program, ExportNotes& notes);

// For programs without any: what to add to which images' stamps.
std::string stampShifts(const Rig& rig);

// As YAML comments: who wrote this, how sure it is, the lines given, and what is to be said of times.
std::string headerComment(const Rig& rig, const std::vector<std::string>& lines);
// The same as text of a file beside a format without comments.
std::string readMe(const Rig& rig, const std::vector<std::string>& lines);

}  // namespace evical
