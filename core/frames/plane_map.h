// Map from the board's plane to a picture, from some detected points: a homography, plus a correction for
// lens distortion from the nearest known points.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <vector>

namespace evical {

class PlaneMap {
 public:
  // Empty if the points do not determine a homography. `step_m` is a typical distance between neighbours.
  static std::optional<PlaneMap> fit(std::vector<Eigen::Vector2d> on_board_m,
                                     const std::vector<Eigen::Vector2d>& in_picture_px, double step_m);

  struct Place {
    Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
    Eigen::Matrix2d px_per_m = Eigen::Matrix2d::Identity();
  };
  Place placeOf(const Eigen::Vector2d& on_board_m) const;
  Eigen::Vector2d at(const Eigen::Vector2d& on_board_m) const { return placeOf(on_board_m).at_px; }

 private:
  Place plain(const Eigen::Vector2d& on_board_m) const;

  Eigen::Matrix3d picture_from_board_ = Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector2d> known_m_, left_px_;  // residuals of the homography
  double step_m_ = 1.0;
};

// Outlier rejection for points that a decoder read from a picture.
struct ReadPoint {
  Eigen::Vector2d on_board_m = Eigen::Vector2d::Zero(), at_px = Eigen::Vector2d::Zero();
};

// The points that fit one plane within `tolerance_px`, which must allow for lens distortion; empty if fewer
// than half fit.
std::vector<ReadPoint> agreeingPoints(const std::vector<ReadPoint>& points, double tolerance_px);

// The map from points; empty if there are too few. `step_m` as for PlaneMap.
std::optional<PlaneMap> mapOf(const std::vector<ReadPoint>& points, double step_m);

// A detected point of the board (Board::point_m) in one frame. Pixels: the centre of the top-left pixel is
// (0, 0).
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
