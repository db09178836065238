// Parts of a ROS camera_info file, which ESVO reads too.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <string>

namespace evical {

Eigen::Matrix3d cameraMatrix(const CameraIntrinsics& camera);

// From image_width to distortion_coefficients; plumb_bob has 5 coefficients, in some readers 4.
std::string cameraInfoBody(const std::string& name, const CameraIntrinsics& camera, int radtan_coefficients);

}  // namespace evical
