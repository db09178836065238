// SPDX-License-Identifier: GPL-3.0-or-later
// Camera of a 3D view: a turntable whose axis stays upright on the screen. Without VTK and Qt widgets.
#pragma once

#include <QPointF>
#include <QSizeF>

#include <Eigen/Core>

#include <optional>

namespace evical::ui {

struct ViewPose {
  Eigen::Vector3d eye_m, focus_m, up;
  double vertical_view_rad = 0.5;

  // Position of a point on the screen; none if it is behind the eye.
  std::optional<QPointF> project(const Eigen::Vector3d& point_m, const QSizeF& screen) const;
  double depth_m(const Eigen::Vector3d& point_m) const;
};

enum class StandardView { Home, Front, Side, Top };

class TurntableCamera {
 public:
  // `front` is the direction of the front view; only its part perpendicular to `up` counts.
  void setAxes(const Eigen::Vector3d& up, const Eigen::Vector3d& front);

  void look(StandardView view);
  // Moves back until this sphere is visible; `aspect` is width / height.
  void fit(const Eigen::Vector3d& centre_m, double radius_m, double aspect);

  void orbit(double azimuth_rad, double elevation_rad);  // positive: eye to the left, eye up
  void pan(double right, double up);                     // of the focus, in heights of the screen
  void zoom(double factor);                              // above 1: closer
  void setFocus(const Eigen::Vector3d& focus_m) { focus_m_ = focus_m; }

  const Eigen::Vector3d& up() const { return up_; }
  ViewPose pose() const;

 private:
  Eigen::Vector3d up_ = -Eigen::Vector3d::UnitY(), front_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d focus_m_ = Eigen::Vector3d::Zero();
  double azimuth_rad_ = 0.0, elevation_rad_ = 0.0;
  double distance_m_ = 1.0, fitted_distance_m_ = 1.0;
};

}  // namespace evical::ui
