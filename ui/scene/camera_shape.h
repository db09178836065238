// SPDX-License-Identifier: GPL-3.0-or-later
// Field of view of a camera as a pyramid.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace evical::ui {

// Corners of the image in the camera frame at z = 1, in order around it.
struct CameraShape {
  std::array<Eigen::Vector3d, 4> corners;
  double vertical_view_rad = 0.0;
};

// Point of a pixel's ray at z = 1; for wide-angle lenses clipped to what can be drawn.
Eigen::Vector3d rayAtUnitDepth(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

// Without intrinsics: a typical camera.
CameraShape cameraShape(const std::optional<CameraIntrinsics>& intrinsics);

}  // namespace evical::ui
