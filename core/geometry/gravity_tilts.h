// Gravity's direction as two small angles.
#pragma once

#include <Eigen/Geometry>

#include <cmath>

namespace evical {

// The two world directions of gravity's tilt in the report ("gravity.direction.1", ".2").
inline Eigen::Matrix<double, 3, 2> gravityTilts(const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d down = gravity.normalized();
  const Eigen::Vector3d seed = std::abs(down.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix<double, 3, 2> tilts;
  tilts.col(0) = (seed - seed.dot(down) * down).normalized();
  tilts.col(1) = down.cross(tilts.col(0));
  return tilts;
}

}  // namespace evical
