// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/camera_shape.h"

#include "core/geometry/camera_model.h"

#include <cmath>

namespace evical::ui {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d cornerRay(const CameraIntrinsics& camera, const Vector2d& pixel) {
  const auto ray = unproject(camera, pixel);
  const Vector2d normalised =
      ray ? *ray : (pixel - camera.principal_point_px).cwiseQuotient(camera.focal_length_px).eval();
  return {normalised.x(), normalised.y(), 1.0};
}

}  // namespace

CameraShape cameraShape(const std::optional<CameraIntrinsics>& intrinsics) {
  CameraIntrinsics camera{CameraModel::PinholeRadtan, {640, 480}, {550.0, 550.0}, {319.5, 239.5}, {}};
  if (intrinsics && intrinsics->resolution_px.known()) camera = *intrinsics;
  const double right = camera.resolution_px.width_px - 0.5, bottom = camera.resolution_px.height_px - 0.5;
  CameraShape shape;
  shape.corners = {cornerRay(camera, {-0.5, -0.5}), cornerRay(camera, {right, -0.5}),
                   cornerRay(camera, {right, bottom}), cornerRay(camera, {-0.5, bottom})};
  shape.vertical_view_rad = 2.0 * std::atan(0.5 * (shape.corners[2].y() - shape.corners[0].y()));
  return shape;
}

}  // namespace evical::ui
