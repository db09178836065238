#include "core/frames/board_finder.h"
#include "core/frames/circle_edges.h"
#include "core/frames/picture_view.h"
#include "core/frames/plane_map.h"
#include "core/geometry/point_lattice.h"

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace evical {
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
