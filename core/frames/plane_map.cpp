#include "core/frames/plane_map.h"

#include "core/geometry/homography.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

#include <utility>

namespace evical {
namespace {

// Regularisation of slopes and second derivatives: few points do not determine them, and extrapolation is
// unreliable.
constexpr double kRidge = 0.003;
constexpr double kFarthest =
    4.0;  // steps; further points have less than a thousandth of the nearest point's weight

}  // namespace

std::optional<PlaneMap> PlaneMap::fit(std::vector<Eigen::Vector2d> on_board_m,
                                      const std::vector<Eigen::Vector2d>& in_picture_px, double step_m) {
  const std::optional<Eigen::Matrix3d> homography = fitHomography(on_board_m, in_picture_px);
  if (!homography) return std::nullopt;
  PlaneMap map;
  map.picture_from_board_ = *homography;
  map.step_m_ = step_m;
  map.known_m_ = std::move(on_board_m);
  for (std::size_t k = 0; k < in_picture_px.size(); ++k)
    map.left_px_.emplace_back(in_picture_px[k] - map.plain(map.known_m_[k]).at_px);
  return map;
}

PlaneMap::Place PlaneMap::plain(const Eigen::Vector2d& on_board_m) const {
  const Eigen::Vector3d image = picture_from_board_ * on_board_m.homogeneous();
  const Eigen::Vector2d at = image.hnormalized();
  return {at, (picture_from_board_.topLeftCorner<2, 2>() - at * picture_from_board_.block<1, 2>(2, 0)) /
                  image.z()};
}

// Second-order surface through the residuals of known points, with weights that decrease with distance.
PlaneMap::Place PlaneMap::placeOf(const Eigen::Vector2d& on_board_m) const {
  Eigen::Matrix<double, 6, 6> sums = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 2> products = Eigen::Matrix<double, 6, 2>::Zero();
  for (std::size_t k = 0; k < known_m_.size(); ++k) {
    const Eigen::Vector2d d = (known_m_[k] - on_board_m) / step_m_;
    if (d.squaredNorm() > kFarthest * kFarthest) continue;
    const double near = 1.0 / (0.5 + d.squaredNorm()), weight = near * near;
    Eigen::Matrix<double, 6, 1> row;
    row << 1.0, d, d.x() * d.x(), d.x() * d.y(), d.y() * d.y();
    sums.noalias() += weight * row * row.transpose();
    products.noalias() += weight * row * left_px_[k].transpose();
  }
  const Place place = plain(on_board_m);
  if (!(sums(0, 0) > 0.0)) return place;
  sums.diagonal().tail<5>().array() += kRidge * sums(0, 0);
  const Eigen::Matrix<double, 6, 2> surface = sums.ldlt().solve(products);
  return {place.at_px + surface.row(0).transpose(),
          place.px_per_m + surface.middleRows<2>(1).transpose() / step_m_};
}

std::vector<ReadPoint> agreeingPoints(const std::vector<ReadPoint>& points, double tolerance_px) {
  if (points.size() < kMinForHomography) return {};
  std::vector<cv::Point2d> from, to;
  for (const ReadPoint& point : points) {
    from.emplace_back(point.on_board_m.x(), point.on_board_m.y());
    to.emplace_back(point.at_px.x(), point.at_px.y());
  }
  std::vector<std::uint8_t> agrees;
  if (cv::findHomography(from, to, cv::RANSAC, tolerance_px, agrees).empty()) return {};
  std::vector<ReadPoint> agreeing;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (agrees[k] != 0) agreeing.push_back(points[k]);
  if (2 * agreeing.size() < points.size()) agreeing.clear();
  return agreeing;
}

std::optional<PlaneMap> mapOf(const std::vector<ReadPoint>& points, double step_m) {
  std::vector<Eigen::Vector2d> on_board, in_picture;
  for (const ReadPoint& point : points) {
    on_board.push_back(point.on_board_m);
    in_picture.push_back(point.at_px);
  }
  return PlaneMap::fit(std::move(on_board), in_picture, step_m);
}

}  // namespace evical
