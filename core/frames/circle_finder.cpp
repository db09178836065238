#include "core/frames/circle_finder.h"

#include "core/frames/board_finder.h"
#include "core/frames/gray_image.h"
#include "core/frames/picture_view.h"
#include "core/frames/plane_map.h"

#include "core/geometry/point_lattice.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <opencv2/imgproc.hpp>

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

namespace {

// Smallest ratio of areas, of an outline and of the ellipse of its moments, for a circle.
constexpr double kMinFill = 0.85, kMaxFill = 1.1;
constexpr double kLargestAspect = 6.0;
constexpr double kSmallestArea_px2 = 12.0;

struct Blob {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d shape_px2 = Eigen::Matrix2d::Zero();  // A A^T of its ellipse
  double radius_px = 0.0;
};

std::optional<Blob> blobOf(const std::vector<cv::Point>& outline, double largest_area_px2) {
  const cv::Moments moments = cv::moments(outline);
  if (moments.m00 < kSmallestArea_px2 || moments.m00 > largest_area_px2) return std::nullopt;
  Blob blob;
  blob.centre_px = {moments.m10 / moments.m00, moments.m01 / moments.m00};
  // A filled ellipse's second moments are a quarter of its semi-axes' squares.
  blob.shape_px2 << moments.mu20, moments.mu11, moments.mu11, moments.mu02;
  blob.shape_px2 *= 4.0 / moments.m00;
  const double product = blob.shape_px2.determinant(), trace = blob.shape_px2.trace();
  if (!(product > 0.0) || trace * trace / product > std::pow(kLargestAspect + 1.0 / kLargestAspect, 2))
    return std::nullopt;
  const double fill = moments.m00 / (std::numbers::pi * std::sqrt(product));
  if (fill < kMinFill || fill > kMaxFill) return std::nullopt;
  std::vector<cv::Point> hull;
  cv::convexHull(outline, hull);
  if (moments.m00 < kMinFill * cv::contourArea(hull)) return std::nullopt;
  // Outlines connect the centres of the outermost pixels.
  const double grown = std::pow(product, 0.25) + 0.5;
  blob.shape_px2 *= grown * grown / std::sqrt(product);
  blob.radius_px = grown;
  return blob;
}

void addBlobs(const cv::Mat& mask, double largest_area_px2, std::vector<Blob>& blobs) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  for (const auto& outline : outlines) {
    const std::optional<Blob> blob = blobOf(outline, largest_area_px2);
    if (!blob) continue;
    const bool known = std::any_of(blobs.begin(), blobs.end(), [&](const Blob& other) {
      return (other.centre_px - blob->centre_px).norm() < 0.5 * std::max(other.radius_px, blob->radius_px);
    });
    if (!known) blobs.push_back(*blob);
  }
}

// Regions that are darker (or brighter) than their neighbourhood, for several sizes of the neighbourhood: it
// must be several times larger than a circle.
std::vector<Blob> findBlobs(const GrayImage& image, CircleShade shade) {
  const cv::Mat picture = viewOf(image);
  cv::Mat smooth;
  cv::GaussianBlur(picture, smooth, {3, 3}, 0.0);
  const int shortest = std::min(picture.cols, picture.rows);
  const double largest_area_px2 = 0.05 * static_cast<double>(picture.total());
  std::vector<Blob> blobs;
  for (const double part : {0.25, 0.1, 0.05}) {
    const int block = std::max(7, static_cast<int>(part * shortest) | 1);
    constexpr double kMinDifference = 6.0;
    cv::Mat mask;
    if (shade == CircleShade::Dark)
      cv::adaptiveThreshold(smooth, mask, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, block,
                            kMinDifference);
    else
      cv::adaptiveThreshold(smooth, mask, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY, block,
                            -kMinDifference);
    addBlobs(mask, largest_area_px2, blobs);
  }
  return blobs;
}

class CircleFinder : public PatternFinder {
 public:
  CircleFinder(const Board& board, const FrameOptions& options) : board_(board), options_(options) {}

  FoundPoints search(const GrayImage& image) override {
    const std::vector<Blob> blobs = findBlobs(image, board_.circles);
    const std::optional<PlaneMap> rough = place(blobs);
    if (!rough) return {};
    // A lens may displace the board's ends from one plane's map: measured outwards from the detected points.
    FoundPoints found = measure(image, *rough, 2.0 * options_.max_move_px);
    const std::optional<PlaneMap> map = mapOf(found, board_);
    return map ? measure(image, *map, options_.max_move_px) : FoundPoints{};
  }

  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const override {
    return measureCircles(image, board_, map, gate_px, options_);
  }

 private:
  // The lattice, with the distances of neighbours on the board.
  CircleLattice latticeOf(const std::vector<Blob>& blobs) const {
    const double step = (board_.type == BoardType::AsymmetricCircles ? std::numbers::sqrt2 : 1.0) *
                        board_.spacing_m / board_.radius_m;
    const LatticeOptions options = {.min_step_radii = 0.4 * step,
                                    .max_step_radii = 2.5 * step,
                                    .max_radius_ratio = 1.5,
                                    .step_tolerance = 0.25,
                                    .min_sine = 0.3,
                                    .min_circles = kFewest};
    std::vector<LatticeCircle> circles;
    for (const Blob& blob : blobs) circles.push_back({blob.centre_px, blob.radius_px});
    return findCircleLattice(circles, options);
  }

  std::optional<PlaneMap> place(const std::vector<Blob>& blobs) const {
    const CircleLattice lattice = latticeOf(blobs);
    if (static_cast<int>(lattice.size()) < kFewest) return std::nullopt;
    std::optional<PlaneMap> best;
    std::size_t most = 0;
    for (const LatticePlacement& placement : layOnBoard(lattice, board_, kNearlyBest)) {
      if (static_cast<int>(placement.circles.size()) < kFewest) continue;
      std::optional<PlaneMap> map = mapOfPlacement(placement, blobs);
      if (!map || !hasShapes(*map, placement, blobs)) continue;
      if (!best) {
        best = std::move(map);
        most = placement.circles.size();
        continue;
      }
      if (isHalfTurnOf(*best, *map)) continue;
      // A part of the board may fit several places equally well: then it is rejected.
      if (placement.circles.size() + kMargin > most) return std::nullopt;
    }
    return best;
  }

  std::optional<PlaneMap> mapOfPlacement(const LatticePlacement& placement,
                                         const std::vector<Blob>& blobs) const {
    std::vector<ReadPoint> known;
    for (const auto& [circle, blob] : placement.circles)
      known.push_back({board_.point_m(circle), blobs[blob].centre_px});
    return mapOf(known, board_.spacing_m);
  }

  // A sheared or shrunk lattice would imply other ellipses than the observed ones.
  bool hasShapes(const PlaneMap& map, const LatticePlacement& placement,
                 const std::vector<Blob>& blobs) const {
    constexpr double kTolerance = 0.35;
    std::vector<double> errors;
    for (const auto& [circle, blob] : placement.circles) {
      const Eigen::Matrix2d a = board_.radius_m * map.placeOf(board_.point_m(circle)).px_per_m;
      const Eigen::Matrix2d expected = a * a.transpose();
      errors.push_back((expected.inverse() * blobs[blob].shape_px2 - Eigen::Matrix2d::Identity()).norm());
    }
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return *middle < kTolerance;
  }

  bool isHalfTurnOf(const PlaneMap& a, const PlaneMap& b) const {
    if (!board_.hasHalfTurnAmbiguity()) return false;
    const Eigen::Vector2d first = board_.point_m(0), last = board_.point_m(board_.pointCount() - 1);
    const double near_px = 0.25 * board_.spacing_m * a.placeOf(first).px_per_m.norm();
    return (a.at(first) - b.at(last)).norm() < near_px && (a.at(last) - b.at(first)).norm() < near_px;
  }

  static constexpr int kFewest = 6;
  static constexpr std::size_t kMargin = 2;
  static constexpr double kNearlyBest = 0.9;

  Board board_;
  FrameOptions options_;
};

}  // namespace

std::unique_ptr<PatternFinder> makeCircleFinder(const Board& board, const FrameOptions& options) {
  return std::make_unique<CircleFinder>(board, options);
}

}  // namespace evical
