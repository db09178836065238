// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/camera_shape.h"

#include "core/geometry/camera_model.h"

#include <algorithm>
#include <cmath>

namespace evical::ui {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d rayAtUnitDepth(const CameraIntrinsics& camera, const Vector2d& pixel) {
  const Vector2d straight = (pixel - camera.principal_point_px).cwiseQuotient(camera.focal_length_px);
  const auto ray = unprojectRay(camera, pixel);
  if (!ray) return {straight.x(), straight.y(), 1.0};
  constexpr double kWidest = 3.0;  // largest x/z that is drawn: wider lenses are clipped to it
  const double length = ray->head<2>().norm(), reach = ray->z() > 0.0 ? length / ray->z() : kWidest;
  const Vector2d shown = ray->head<2>() * (std::min(reach, kWidest) / std::max(length, 1e-12));
  return {shown.x(), shown.y(), 1.0};
}

CameraShape cameraShape(const std::optional<CameraIntrinsics>& intrinsics) {
  CameraIntrinsics camera{CameraModel::PinholeRadtan, {640, 480}, {550.0, 550.0}, {319.5, 239.5}, {}};
  if (intrinsics && intrinsics->resolution_px.known()) camera = *intrinsics;
  const double right = camera.resolution_px.width_px - 0.5, bottom = camera.resolution_px.height_px - 0.5;
  CameraShape shape;
  shape.corners = {rayAtUnitDepth(camera, {-0.5, -0.5}), rayAtUnitDepth(camera, {right, -0.5}),
                   rayAtUnitDepth(camera, {right, bottom}), rayAtUnitDepth(camera, {-0.5, bottom})};
  shape.vertical_view_rad = 2.0 * std::atan(0.5 * (shape.corners[2].y() - shape.corners[0].y()));
  return shape;
}

}  // namespace evical::ui
