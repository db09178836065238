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

// The first two cameras, whichever of them is the left one; nothing where there is one only, or where they don't
// sit side by side.
std::optional<StereoPair> sideBySide(const Rig& rig);

// The same for a program that can do nothing else: throws CalibrationError (BadInput) where there is none.
StereoPair stereoPair(const Rig& rig, const char* program);

// OpenCV's: E = [t]x R in normalised coordinates, second^T E first = 0.
Eigen::Matrix3d essentialMatrix(const RigidTransform& second_from_first);
// The same in undistorted pixels: second_px^T F first_px = 0.
Eigen::Matrix3d fundamentalMatrix(const CameraIntrinsics& first, const CameraIntrinsics& second,
                                  const RigidTransform& second_from_first);

// Both cameras turned so that a point lies in one row of both: half the rotation between them each,
// then the baseline onto x (Bouguet's method). One focal length and principal point for both, in
// which the image's middle stays.
struct Rectification {
  Eigen::Matrix3d rectified_from_left, rectified_from_right;
  Eigen::Matrix<double, 3, 4> left_projection, right_projection;  // of a point in the left rectified frame
};
Rectification rectify(const CameraIntrinsics& left, const CameraIntrinsics& right,
                      const RigidTransform& right_from_left);

}  // namespace evical
