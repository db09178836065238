// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/turntable_camera.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

using Eigen::Vector3d;

constexpr double kVerticalView_rad = 0.52;  // a long lens: parallel lines stay nearly parallel
constexpr double kHomeAzimuth_rad = -0.65, kHomeElevation_rad = 0.4;
constexpr double kClosest = 0.02, kFurthest = 20.0;  // relative to the distance at which everything fits

}  // namespace

std::optional<QPointF> ViewPose::project(const Vector3d& point_m, const QSizeF& screen) const {
  const Vector3d forward = (focus_m - eye_m).normalized();
  const Vector3d right = forward.cross(up).normalized();
  const Vector3d from_eye = point_m - eye_m;
  const double depth = forward.dot(from_eye);
  if (depth <= 0.0) return std::nullopt;
  const double pixels = 0.5 * screen.height() / (depth * std::tan(0.5 * vertical_view_rad));
  return QPointF(0.5 * screen.width() + pixels * right.dot(from_eye),
                 0.5 * screen.height() - pixels * right.cross(forward).dot(from_eye));
}

double ViewPose::depth_m(const Vector3d& point_m) const {
  return (focus_m - eye_m).normalized().dot(point_m - eye_m);
}

void TurntableCamera::setAxes(const Vector3d& up, const Vector3d& front) {
  up_ = up.normalized();
  const Vector3d level = front - front.dot(up_) * up_;
  front_ = level.norm() > 1e-6 * front.norm() ? level.normalized() : up_.unitOrthogonal();
}

void TurntableCamera::look(StandardView view) {
  azimuth_rad_ = view == StandardView::Home ? kHomeAzimuth_rad : view == StandardView::Side ? -M_PI_2 : 0.0;
  elevation_rad_ = view == StandardView::Home ? kHomeElevation_rad : view == StandardView::Top ? M_PI_2 : 0.0;
}

void TurntableCamera::fit(const Vector3d& centre_m, double radius_m, double aspect) {
  const double half_view = std::atan(std::tan(0.5 * kVerticalView_rad) * std::min(1.0, aspect));
  focus_m_ = centre_m;
  fitted_distance_m_ = std::max(radius_m, 1e-3) / std::sin(half_view);
  distance_m_ = fitted_distance_m_;
}

void TurntableCamera::orbit(double azimuth_rad, double elevation_rad) {
  azimuth_rad_ = std::remainder(azimuth_rad_ + azimuth_rad, 2.0 * M_PI);
  elevation_rad_ = std::clamp(elevation_rad_ + elevation_rad, -M_PI_2, M_PI_2);
}

void TurntableCamera::pan(double right, double up) {
  const ViewPose now = pose();
  const double height_m = 2.0 * distance_m_ * std::tan(0.5 * now.vertical_view_rad);
  const Vector3d across = (now.focus_m - now.eye_m).cross(now.up).normalized();
  focus_m_ += height_m * (right * across + up * now.up);
}

void TurntableCamera::zoom(double factor) {
  distance_m_ =
      std::clamp(distance_m_ / factor, kClosest * fitted_distance_m_, kFurthest * fitted_distance_m_);
}

ViewPose TurntableCamera::pose() const {
  const Vector3d right = front_.cross(up_);
  const Vector3d level = std::cos(azimuth_rad_) * front_ + std::sin(azimuth_rad_) * right;
  const double c = std::cos(elevation_rad_), s = std::sin(elevation_rad_);
  const Vector3d direction = c * level - s * up_;
  return {focus_m_ - distance_m_ * direction, focus_m_, s * level + c * up_, kVerticalView_rad};
}

}  // namespace evical::ui
