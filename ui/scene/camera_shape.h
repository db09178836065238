// SPDX-License-Identifier: GPL-3.0-or-later
// What a camera sees, as a pyramid.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace evical::ui {

// The image's corners in the camera frame at z = 1, in order around it.
struct CameraShape {
  std::array<Eigen::Vector3d, 4> corners;
  double vertical_view_rad = 0.0;
};

// Where a pixel's ray is at z = 1; of lenses that see very far aside, no further than can be drawn.
Eigen::Vector3d rayAtUnitDepth(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

// Without intrinsics, a camera like any other.
CameraShape cameraShape(const std::optional<CameraIntrinsics>& intrinsics);

}  // namespace evical::ui
