// Sector of a circle's outline that an edge belongs to: sixteen sectors, without computing an angle.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>

namespace evical {

constexpr int kOutlineSectors = 16;

// Sector of a normal of any length; sectors of 22.5 degrees, numbered.
inline std::size_t outlineSector(const Eigen::Vector2d& normal) {
  constexpr double kTan22 = 0.41421356237309503;
  const double ax = std::abs(normal.x()), ay = std::abs(normal.y());
  const std::size_t part = ay < ax ? (ay < kTan22 * ax ? 0 : 1) : (ax < kTan22 * ay ? 3 : 2);
  return part + (normal.x() < 0.0 ? 4 : 0) + (normal.y() < 0.0 ? 8 : 0);
}

}  // namespace evical
