#include "core/frames/circle_edges.h"

#include "core/frames/brightness.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace evical {
namespace {

constexpr double kStep_px = 0.5;  // along a normal
constexpr double kBetweenEdgePoints_px = 1.5;
constexpr int kFewestEdgePoints = 10, kMaxEdgePoints = 60;
constexpr double kMinSeen = 0.7;  // smallest share of the normals with an edge
constexpr int kRounds = 3;

using Shift =
    Eigen::Matrix<double, 5, 1>;  // centre; a symmetric matrix S: from_unit_circle += S from_unit_circle

struct EdgePoint {
  Eigen::Vector2d normal, on_ellipse, unit;
  double off_px = 0.0;  // outwards from the ellipse
};

struct Axes {
  double smallest_px = 0.0, perimeter_px = 0.0;
};

Axes axesOf(const Ellipse& ellipse) {
  const Eigen::Vector2d axes = ellipse.from_unit_circle.jacobiSvd().singularValues();
  return {axes(1), std::numbers::pi * axes.sum()};
}

// Position of the edge along its normal: the middle of the brightness change around its steepest place.
// `sign` is 1 if brightness grows outwards.
std::optional<double> edgeAlong(const GrayImage& image, const EdgePoint& point, double reach_px, double sign,
                                double min_contrast) {
  constexpr int kMaxSteps = 64, kAround = 3;
  const int steps = std::min(static_cast<int>(std::ceil(reach_px / kStep_px)), kMaxSteps);
  const double outermost = (steps + 1) * kStep_px;
  if (!isInside(image, point.on_ellipse + outermost * point.normal, 0.0) ||
      !isInside(image, point.on_ellipse - outermost * point.normal, 0.0))
    return std::nullopt;
  std::array<double, 2 * kMaxSteps + 4> profile{};
  const int count = 2 * steps + 3;
  for (int k = 0; k < count; ++k)
    profile.at(static_cast<std::size_t>(k)) =
        sign * brightnessAt(image, point.on_ellipse + (k - steps - 1) * kStep_px * point.normal);
  const auto slope = [&](int k) {
    return std::max(
        0.0, profile.at(static_cast<std::size_t>(k + 1)) - profile.at(static_cast<std::size_t>(k - 1)));
  };
  int steepest = 1;
  for (int k = 2; k + 1 < count; ++k)
    if (slope(k) > slope(steepest)) steepest = k;
  double sum = 0.0, moment = 0.0;
  for (int k = std::max(1, steepest - kAround); k <= std::min(count - 2, steepest + kAround); ++k) {
    sum += slope(k);
    moment += slope(k) * (k - steps - 1) * kStep_px;
  }
  // Each slope covers two steps: half their sum is the change of brightness.
  if (0.5 * sum < min_contrast) return std::nullopt;
  return moment / sum;
}

std::vector<EdgePoint> edgePoints(const GrayImage& image, const Ellipse& ellipse, double reach_px,
                                  double sign, double min_contrast, int normals) {
  const Eigen::Matrix2d to_normal = ellipse.from_unit_circle.inverse().transpose();
  std::vector<EdgePoint> points;
  for (int k = 0; k < normals; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / normals;
    EdgePoint point;
    point.unit = {std::cos(angle), std::sin(angle)};
    point.normal = (to_normal * point.unit).normalized();
    point.on_ellipse = ellipse.centre_px + ellipse.from_unit_circle * point.unit;
    const std::optional<double> off = edgeAlong(image, point, reach_px, sign, min_contrast);
    if (!off) continue;
    point.off_px = *off;
    points.push_back(point);
  }
  return points;
}

// Displacement of the ellipse at the point, along its normal, per component of a shift.
Shift rowOf(const EdgePoint& point, const Ellipse& ellipse) {
  const Eigen::Vector2d n = point.normal, e = point.on_ellipse - ellipse.centre_px;
  return (Shift() << n.x(), n.y(), n.x() * e.x(), n.y() * e.y(), n.x() * e.y() + n.y() * e.x()).finished();
}

struct Fit {
  Shift shift = Shift::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double rms_px = 0.0;
};

std::optional<Fit> fit(std::vector<EdgePoint> points, const Ellipse& ellipse) {
  constexpr double kOutlier = 3.5;  // in RMS errors
  for (int round = 0;; ++round) {
    if (static_cast<int>(points.size()) < kFewestEdgePoints) return std::nullopt;
    Eigen::Matrix<double, 5, 5> sums = Eigen::Matrix<double, 5, 5>::Zero();
    Shift products = Shift::Zero();
    for (const EdgePoint& point : points) {
      const Shift row = rowOf(point, ellipse);
      sums += row * row.transpose();
      products += point.off_px * row;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 5, 5>> solver(sums);
    Fit result;
    result.shift = solver.solve(products);
    if (!result.shift.allFinite()) return std::nullopt;
    double squares = 0.0;
    const auto error = [&](const EdgePoint& p) { return p.off_px - rowOf(p, ellipse).dot(result.shift); };
    for (const EdgePoint& point : points) squares += error(point) * error(point);
    const double variance = squares / (static_cast<double>(points.size()) - 5.0);
    result.rms_px = std::sqrt(variance);
    const Eigen::Matrix<double, 5, 5> inverse = solver.solve(Eigen::Matrix<double, 5, 5>::Identity());
    result.covariance_px2 = variance * inverse.topLeftCorner<2, 2>();
    const auto dropped = std::erase_if(
        points, [&](const EdgePoint& p) { return std::abs(error(p)) > kOutlier * result.rms_px; });
    constexpr int kMaxPasses = 3;
    if (dropped == 0 || round >= kMaxPasses) return result;
  }
}

Ellipse shifted(const Ellipse& ellipse, const Shift& shift) {
  const Eigen::Matrix2d s = (Eigen::Matrix2d() << shift(2), shift(4), shift(4), shift(3)).finished();
  return {ellipse.centre_px + shift.head<2>(), ellipse.from_unit_circle + s * ellipse.from_unit_circle};
}

}  // namespace

std::optional<MeasuredEllipse> measureEllipse(const GrayImage& image, const Ellipse& expected,
                                              double reach_px, CircleShade shade, double min_contrast) {
  constexpr double kSmallestAxis_px = 1.5, kLargestRms_px = 0.6, kLastReach_px = 3.0, kSettled_px = 0.05;
  const Axes axes = axesOf(expected);
  if (!(axes.smallest_px > kSmallestAxis_px)) return std::nullopt;
  const int normals =
      std::clamp(static_cast<int>(axes.perimeter_px / kBetweenEdgePoints_px), 12, kMaxEdgePoints);
  const double sign = shade == CircleShade::Dark ? 1.0 : -1.0;
  MeasuredEllipse measured{expected, {}};
  double rms_px = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const double reach = round == 0 ? reach_px : std::min(reach_px, kLastReach_px);
    const std::vector<EdgePoint> points = edgePoints(
        image, measured.ellipse, std::min(reach, 0.9 * axes.smallest_px), sign, min_contrast, normals);
    if (static_cast<double>(points.size()) < kMinSeen * normals) return std::nullopt;
    const std::optional<Fit> found = fit(points, measured.ellipse);
    if (!found) return std::nullopt;
    measured.ellipse = shifted(measured.ellipse, found->shift);
    const Axes now = axesOf(measured.ellipse);
    if (!(now.smallest_px > 0.5 * axes.smallest_px && now.perimeter_px < 2.0 * axes.perimeter_px))
      return std::nullopt;
    measured.covariance_px2 = found->covariance_px2;
    rms_px = found->rms_px;
    if (round > 0 && found->shift.head<2>().norm() < kSettled_px) break;
  }
  if (rms_px > kLargestRms_px) return std::nullopt;
  return measured;
}

FoundPoints measureCircles(const GrayImage& image, const Board& board, const PlaneMap& map, double gate_px,
                           const FrameOptions& options) {
  const double contrast = std::max(options.min_contrast, 2.0 * noiseSigma(image));
  const double nearest_m =
      board.spacing_m * (board.type == BoardType::AsymmetricCircles ? std::numbers::sqrt2 : 1.0);
  const double between = (nearest_m - 2.0 * board.radius_m) / board.radius_m;  // of circles, in radii
  FoundPoints found;
  for (int point = 0; point < board.pointCount(); ++point) {
    const PlaneMap::Place place = map.placeOf(board.point_m(point));
    const Ellipse expected{place.at_px, board.radius_m * place.px_per_m};
    const double smallest_px = axesOf(expected).smallest_px;
    // Limited by the distance of the next circle's edge.
    const double reach_px = std::min({gate_px + 1.5, 0.9 * between * smallest_px, 0.9 * smallest_px});
    const std::optional<MeasuredEllipse> ellipse =
        measureEllipse(image, expected, reach_px, board.circles, contrast);
    if (!ellipse || (ellipse->ellipse.centre_px - expected.centre_px).norm() > gate_px) continue;
    const double floor_px2 = options.min_sigma_px * options.min_sigma_px;
    const Eigen::Matrix2d& shape = ellipse->ellipse.from_unit_circle;
    found.push_back({point, ellipse->ellipse.centre_px,
                     ellipse->covariance_px2 + floor_px2 * Eigen::Matrix2d::Identity(),
                     shape * shape.transpose()});
  }
  return found;
}

}  // namespace evical
