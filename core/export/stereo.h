// Two cameras side by side as one stereo pair.
#pragma once

#include "core/export/rig.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

struct StereoPair {
  RigCamera left, right;
  RigidTransform right_from_left;
};

// The first two cameras, in either order; nullopt if there is only one, or if they are not
// side by side.
std::optional<StereoPair> sideBySide(const Rig& rig);

// For programs that require a pair: throws CalibrationError (BadInput) without one.
StereoPair stereoPair(const Rig& rig, const char* program);

// Essential matrix as in OpenCV: E = [t]x R in normalised coordinates, second^T E first = 0.
Eigen::Matrix3d essentialMatrix(const RigidTransform& second_from_first);
// Fundamental matrix in undistorted pixels: second_px^T F first_px = 0.
Eigen::Matrix3d fundamentalMatrix(const CameraIntrinsics& first, const CameraIntrinsics& second,
                                  const RigidTransform& second_from_first);

// Rotates both cameras so that a point is in the same row of both: half of the rotation between them each,
// then the baseline onto x (Bouguet's method). Both share one focal length and one principal point, which
// keep the image's middle.
struct Rectification {
  Eigen::Matrix3d rectified_from_left, rectified_from_right;
  Eigen::Matrix<double, 3, 4> left_projection, right_projection;  // of a point in the left rectified frame
};
Rectification rectify(const CameraIntrinsics& left, const CameraIntrinsics& right,
                      const RigidTransform& right_from_left);

// Cameras by their names in data sets of stereo event and frame cameras.
struct DataSetCameras {
  std::optional<RigCamera> left_event, right_event;  // left_event always exists
  std::optional<RigCamera> left_frame, right_frame;
};

// The first two cameras of each kind; a single one is the left one. Cameras of another program's points count
// as event cameras. Notes state the assignment, and the omitted cameras. Throws CalibrationError (BadInput)
// if there is no event camera, or if two of a kind are not side by side.
DataSetCameras dataSetCameras(const Rig& rig, const char* program, ExportNotes& notes);

}  // namespace evical
