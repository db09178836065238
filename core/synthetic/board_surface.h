// The simulated board's sheet if it is bent: BoardState's parabola (core/data/calibration_state.h) in metres
// of the real board.
#pragma once

#include "core/synthetic/scenario.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>

namespace evical {

class BoardSurface {
 public:
  explicit BoardSurface(const Scenario& scenario);

  bool isBent() const { return bent_; }

  // Distance behind the plane that touches it at its origin, and the slope relative to it.
  double behind_m(const Eigen::Vector2d& p) const { return 0.5 * p.dot(curvature_1_m_ * p); }
  Eigen::Vector2d slope(const Eigen::Vector2d& p) const { return curvature_1_m_ * p; }
  const Eigen::Matrix2d& curvature_1_m() const { return curvature_1_m_; }

  // Intersection with the sheet of a ray that leaves the camera at `camera_m` and meets the plane at
  // `on_plane_m`.
  struct Hit {
    Eigen::Vector2f point_m;
    Eigen::Matrix2f stretch;  // d(point_m) / d(on_plane_m)
  };
  Hit hit(const Eigen::Vector2f& on_plane_m, const Eigen::Vector3f& camera_m) const;

 private:
  bool bent_;
  Eigen::Matrix2d curvature_1_m_;  // of rows and columns, and twist
  Eigen::Matrix2f rounded_1_m_;
};

// With x = on_plane + z along, and z = x' C x / 2: a quadratic equation. Rays that miss the sheet, far beyond
// its edge, stay on the plane.
inline BoardSurface::Hit BoardSurface::hit(const Eigen::Vector2f& on_plane_m,
                                           const Eigen::Vector3f& camera_m) const {
  const float depth_m = -camera_m.z();
  const Eigen::Vector2f along = (on_plane_m - camera_m.head<2>()) / depth_m, steep = rounded_1_m_ * along;
  const float a = 0.5f * along.dot(steep), b = 1.0f - on_plane_m.dot(steep),
              c = 0.5f * on_plane_m.dot(rounded_1_m_ * on_plane_m);
  const float root = b * b - 4.0f * a * c;
  if (!(root > 0.0f) || !(b > 0.0f)) return {on_plane_m, Eigen::Matrix2f::Identity()};
  const float z = 2.0f * c / (b + std::sqrt(root));
  const Eigen::Vector2f point = on_plane_m + z * along;
  const Eigen::Matrix2f against = Eigen::Matrix2f::Identity() - along * (rounded_1_m_ * point).transpose();
  return {point, against.inverse() * (1.0f + z / depth_m)};
}

}  // namespace evical
