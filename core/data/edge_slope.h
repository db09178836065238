// Slope of an edge's passing time over the image: the inverse of the edge's speed, along its normal.
// docs/maths.md, 16.1.
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace evical {

struct EdgeSlope {
  std::int64_t time_ns;  // when the edge passed this pixel
  std::uint16_t x_px, y_px;
  Eigen::Vector2f slope_s_px;  // d(time) / d(pixel)
  Eigen::Vector3f shape;       // xx, xy, yy of its covariance for timing errors of 1 s

  Eigen::Matrix2d covarianceAt1s() const {
    Eigen::Matrix2d covariance;
    covariance << shape[0], shape[1], shape[1], shape[2];
    return covariance;
  }
};
static_assert(sizeof(EdgeSlope) == 32);

}  // namespace evical
