// Parts of ROS files, which other programs also read.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <string>

namespace evical {

Eigen::Matrix3d cameraMatrix(const CameraIntrinsics& camera);

// R = Rz(yaw) Ry(pitch) Rx(roll), about fixed axes, as in URDF and tf. If pitch is +-90 degrees, roll and yaw
// rotate about the same axis: roll is 0 then.
Eigen::Vector3d rollPitchYaw(const Eigen::Matrix3d& rotation);

// Keys from image_width to distortion_coefficients; plumb_bob has 5 coefficients, in some readers 4.
std::string cameraInfoBody(const std::string& name, const CameraIntrinsics& camera, int radtan_coefficients);

// A whole camera_info file. ROS supports pinhole models only: other lenses are refitted, and a comment states the error.
std::string cameraInfoYaml(const std::string& name, const CameraIntrinsics& camera);

}  // namespace evical
