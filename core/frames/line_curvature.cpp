#include "core/frames/line_curvature.h"

#include "core/geometry/homography.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace evical {
namespace {

// Two neighbours each way, and no more of them where they are denser, as those of tags are.
constexpr double kReach_steps = 2.9;
constexpr std::size_t kMostPoints = 25;
constexpr int kTerms = 6;  // 1, x, y, x^2 / 2, x y, y^2 / 2

// Straight lines of the board are straight ones of the plane that a homography makes of it; what bends them is how places
// in the picture follow from those in the plane.
struct NearPoints {
  std::vector<Eigen::Vector2d> on_board_m, in_picture_px;
};

NearPoints near(const Eigen::Vector2d& middle_m, const FoundPoints& found, const Board& board) {
  const auto distance_m = [&](const FoundPoint& each) {
    return (board.point_m(each.point) - middle_m).norm();
  };
  FoundPoints nearest;
  std::ranges::copy_if(found, std::back_inserter(nearest), [&](const FoundPoint& each) {
    return distance_m(each) < kReach_steps * board.spacing_m;
  });
  std::ranges::sort(nearest, {}, distance_m);
  nearest.resize(std::min(nearest.size(), kMostPoints));
  NearPoints points;
  for (const FoundPoint& each : nearest) {
    points.on_board_m.push_back(board.point_m(each.point));
    points.in_picture_px.push_back(each.at_px);
  }
  return points;
}

// The picture of the second order that points make of the plane around its origin.
struct LocalMap {
  Eigen::Matrix<double, kTerms, 2> terms;

  static Eigen::Vector<double, kTerms> at(const Eigen::Vector2d& plane) {
    const double x = plane.x(), y = plane.y();
    return {1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y};
  }
  BentLine along(const Eigen::Vector2d& way) const {
    const Eigen::Vector2d slope = (way.x() * terms.row(1) + way.y() * terms.row(2)).transpose();
    const Eigen::Vector2d bend = (way.x() * way.x() * terms.row(3) + 2.0 * way.x() * way.y() * terms.row(4) +
                                  way.y() * way.y() * terms.row(5))
                                     .transpose();
    BentLine line;
    line.normal = Eigen::Vector2d(-slope.y(), slope.x()).normalized();
    line.curvature_1_px = line.normal.dot(bend) / slope.squaredNorm();
    return line;
  }
};

}  // namespace

std::optional<std::array<BentLine, 2>> linesThrough(int point, const FoundPoints& found, const Board& board) {
  const Eigen::Vector2d middle_m = board.point_m(point);
  const NearPoints points = near(middle_m, found, board);
  if (points.on_board_m.size() <= kTerms) return std::nullopt;
  const std::optional<Eigen::Matrix3d> plane_from_board =
      fitHomography(points.on_board_m, points.in_picture_px);
  if (!plane_from_board) return std::nullopt;
  const auto inPlane = [&](const Eigen::Vector2d& on_board_m) -> Eigen::Vector2d {
    return (*plane_from_board * on_board_m.homogeneous()).hnormalized();
  };
  const Eigen::Vector2d middle = inPlane(middle_m);
  const auto wayTo = [&](const Eigen::Vector2d& step_m) -> Eigen::Vector2d {
    return 0.5 * (inPlane(middle_m + step_m) - inPlane(middle_m - step_m));
  };
  const double short_m = 0.01 * board.spacing_m;
  const Eigen::Vector2d along_row = wayTo({short_m, 0.0}), along_column = wayTo({0.0, short_m});
  const double step_px = 100.0 * std::max(along_row.norm(), along_column.norm());

  Eigen::Matrix<double, kTerms, kTerms> squares = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Eigen::Matrix<double, kTerms, 2> products = Eigen::Matrix<double, kTerms, 2>::Zero();
  for (std::size_t k = 0; k < points.on_board_m.size(); ++k) {
    const double steps2 =
        (points.on_board_m[k] - middle_m).squaredNorm() / (board.spacing_m * board.spacing_m);
    const double weight =
        1.0 / ((0.3 + steps2) * (0.3 + steps2));  // the nearest, for a lens has higher orders
    const Eigen::Vector<double, kTerms> row =
        LocalMap::at((inPlane(points.on_board_m[k]) - middle) / step_px);
    squares += weight * row * row.transpose();
    products += weight * row * points.in_picture_px[k].transpose();
  }
  const Eigen::LDLT<Eigen::Matrix<double, kTerms, kTerms>> solver(squares);
  constexpr double kLeastPivot =
      1e-3;  // as small where two rows leave nothing to tell a second derivative by
  if (!(solver.vectorD().minCoeff() > kLeastPivot)) return std::nullopt;
  const LocalMap map{solver.solve(products)};
  return std::array{map.along(along_row), map.along(along_column)};
}

}  // namespace evical
