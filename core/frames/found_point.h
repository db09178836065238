// A detected point of the board (Board::point_m) in one frame. Pixels: the centre of the top-left pixel is
// (0, 0).
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace evical {

struct FoundPoint {
  int point = 0;
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d ellipse_px2 =
      Eigen::Matrix2d::Zero();  // d^T ellipse^-1 d = 1 on a circle's edge; 0: a corner
};

// In order of their indices, each at most once.
using FoundPoints = std::vector<FoundPoint>;

// Removes points that are not in the other list.
inline void keepThoseOf(const FoundPoints& other, FoundPoints& points) {
  std::erase_if(points, [&](const FoundPoint& point) {
    return !std::binary_search(other.begin(), other.end(), point,
                               [](const FoundPoint& a, const FoundPoint& b) { return a.point < b.point; });
  });
}

}  // namespace evical
