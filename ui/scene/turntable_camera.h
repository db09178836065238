// SPDX-License-Identifier: GPL-3.0-or-later
// Where a 3D view is seen from: a turntable that keeps its axis upright on the screen. No
// VTK and no Qt widgets.
#pragma once

#include <QPointF>
#include <QSizeF>

#include <Eigen/Core>

#include <optional>

namespace evical::ui {

struct ViewPose {
  Eigen::Vector3d eye_m, focus_m, up;
  double vertical_view_rad = 0.5;

  // Where on the screen a point appears; nothing if it lies behind the eye.
  std::optional<QPointF> project(const Eigen::Vector3d& point_m, const QSizeF& screen) const;
  double depth_m(const Eigen::Vector3d& point_m) const;
};

enum class StandardView { Home, Front, Side, Top };

class TurntableCamera {
 public:
  // `front` is where the front view looks; only its part across `up` counts.
  void setAxes(const Eigen::Vector3d& up, const Eigen::Vector3d& front);

  void look(StandardView view);
  // Goes as far away as it takes to see this sphere; `aspect` is width / height.
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
