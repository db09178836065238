#include "core/frames/line_curvature.h"

#include "core/geometry/homography.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace evical {
namespace {

constexpr int kTerms = 6;  // 1, x, y, x^2 / 2, x y, y^2 / 2

// Map from a plane to the picture around its origin, to second order.
class LocalMap {
 public:
  void add(const Eigen::Vector2d& in_plane, const Eigen::Vector2d& in_picture_px, double weight) {
    const double x = in_plane.x(), y = in_plane.y();
    const Eigen::Vector<double, kTerms> row{1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y};
    squares_ += weight * row * row.transpose();
    products_ += weight * row * in_picture_px.transpose();
  }
  // False if points are in too few rows for second derivatives.
  bool solve() {
    constexpr double kLeastPivot = 1e-3;
    const Eigen::LDLT<Eigen::Matrix<double, kTerms, kTerms>> solver(squares_);
    if (!(solver.vectorD().minCoeff() > kLeastPivot)) return false;
    terms_ = solver.solve(products_);
    return true;
  }
  BentLine along(const Eigen::Vector2d& way) const {
    const Eigen::Vector2d slope = (way.x() * terms_.row(1) + way.y() * terms_.row(2)).transpose();
    const Eigen::Vector2d bend = (way.x() * way.x() * terms_.row(3) +
                                  2.0 * way.x() * way.y() * terms_.row(4) + way.y() * way.y() * terms_.row(5))
                                     .transpose();
    BentLine line;
    line.normal = Eigen::Vector2d(-slope.y(), slope.x()).normalized();
    line.curvature_1_px = line.normal.dot(bend) / slope.squaredNorm();
    return line;
  }

 private:
  Eigen::Matrix<double, kTerms, kTerms> squares_ = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Eigen::Matrix<double, kTerms, 2> products_ = Eigen::Matrix<double, kTerms, 2>::Zero();
  Eigen::Matrix<double, kTerms, 2> terms_ = Eigen::Matrix<double, kTerms, 2>::Zero();
};

}  // namespace

BentLines::BentLines(const FoundPoints& found, const Board& board) : step_m_(board.spacing_m) {
  for (const FoundPoint& each : found) {
    on_board_m_.push_back(board.point_m(each.point));
    in_picture_px_.push_back(each.at_px);
  }
}

BentLines::Neighbours BentLines::around(std::size_t index) const {
  // Two neighbours in each direction; for denser points, as of tags, the same number.
  constexpr double kReach_steps = 2.9;
  constexpr std::size_t kMostPoints = 25;
  std::vector<std::pair<double, std::size_t>> near;  // squared distance, index
  for (std::size_t k = 0; k < on_board_m_.size(); ++k) {
    const double squared_m2 = (on_board_m_[k] - on_board_m_[index]).squaredNorm();
    if (squared_m2 < kReach_steps * kReach_steps * step_m_ * step_m_) near.emplace_back(squared_m2, k);
  }
  const std::size_t taken = std::min(near.size(), kMostPoints);
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(taken), near.end());
  Neighbours points;
  for (std::size_t k = 0; k < taken; ++k) {
    points.on_board_m.push_back(on_board_m_[near[k].second]);
    points.in_picture_px.push_back(in_picture_px_[near[k].second]);
  }
  return points;
}

// A homography maps straight lines of the board to straight lines of its plane. Their curvature follows from
// the map from that plane to the picture.
std::optional<std::array<BentLine, 2>> BentLines::through(std::size_t index) const {
  const Neighbours points = around(index);
  if (points.on_board_m.size() <= kTerms) return std::nullopt;
  const auto plane_from_board = fitHomography(points.on_board_m, points.in_picture_px);
  if (!plane_from_board) return std::nullopt;
  const Eigen::Vector2d& middle_m = on_board_m_[index];
  const auto inPlane = [&](const Eigen::Vector2d& on_board_m) -> Eigen::Vector2d {
    return (*plane_from_board * on_board_m.homogeneous()).hnormalized();
  };
  constexpr double kShort_steps = 0.01;
  const auto wayAlong = [&](const Eigen::Vector2d& axis) -> Eigen::Vector2d {
    const Eigen::Vector2d short_m = kShort_steps * step_m_ * axis;
    return (inPlane(middle_m + short_m) - inPlane(middle_m - short_m)) / (2.0 * kShort_steps);
  };
  const Eigen::Vector2d along_row = wayAlong(Eigen::Vector2d::UnitX()),
                        along_column = wayAlong(Eigen::Vector2d::UnitY());
  const double step_px = std::max(along_row.norm(), along_column.norm());
  LocalMap map;
  const Eigen::Vector2d middle = inPlane(middle_m);
  for (std::size_t k = 0; k < points.on_board_m.size(); ++k) {
    // The nearest points have the largest weight, since a lens has higher orders.
    const double weight = 1.0 / (0.3 + (points.on_board_m[k] - middle_m).squaredNorm() / (step_m_ * step_m_));
    map.add((inPlane(points.on_board_m[k]) - middle) / step_px, points.in_picture_px[k], weight * weight);
  }
  if (!map.solve()) return std::nullopt;
  return std::array{map.along(along_row), map.along(along_column)};
}

}  // namespace evical
