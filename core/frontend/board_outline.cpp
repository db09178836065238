#include "core/frontend/board_outline.h"

#include "core/geometry/camera_model.h"
#include "core/numerics/robust.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace evical {
namespace {

// Lengths in the sensor's pixels.
// Next to the end of an edge, the blur of the corner displaces bursts. Single events are less exact and too
// few.
constexpr double kCornerGap_px = 1.5, kCornerGapForSingleEvents_px = 0.5;
constexpr double kShortest_px = 1.5;  // of what remains of an edge
// To the next parallel edge, which displaces bursts, too. Light on narrow ink changes its darkness by a large
// factor, and pixels see factors; on narrow paper it hardly matters.
constexpr double kMinPaper_px = 2.0;
constexpr double kSmallestScale = 0.5;  // of ideal pixels per pixel
constexpr double kSector_px = 8.0;      // along an edge

// Position in the sensor, and ideal pixels per pixel there.
struct SensorPlace {
  Eigen::Vector2d at_px;
  Eigen::Matrix2d ideal_per_px = Eigen::Matrix2d::Identity();
  double scale = 1.0;
};

std::optional<SensorPlace> sensorPlace(const BoardScene& scene, const Eigen::Vector2d& ideal_pixel) {
  SensorPlace place{ideal_pixel};
  if (!scene.camera) return place;
  place.at_px = pixelFromIdeal(*scene.camera, ideal_pixel);
  place.ideal_per_px = idealPixelScale(*scene.camera, ideal_pixel);
  place.scale = std::sqrt(std::abs(place.ideal_per_px.determinant()));
  if (!(place.scale > 1e-3)) return std::nullopt;
  return place;
}

double cornerGap_px(const BoardScene& scene) {
  return scene.single_events ? kCornerGapForSingleEvents_px : kCornerGap_px;
}

bool touchesImage(const OutlineImage& outline, Resolution size_px) {
  const Eigen::Vector2d &c = outline.sensor_centre_px, &r = outline.sensor_reach_px;
  return c.x() >= -r.x() && c.y() >= -r.y() && c.x() <= size_px.width_px + r.x() &&
         c.y() <= size_px.height_px + r.y();
}

// The part of an edge between two gaps at its ends.
std::optional<OutlineImage> imageOfEdge(const Eigen::Matrix3d& h, const BoardScene& scene,
                                        const PrintedEdge& edge, double gap_from_px, double gap_to_px) {
  const Eigen::Vector3d from = h * edge.from_m.homogeneous(), to = h * edge.to_m.homogeneous();
  if (!(from.z() > 0.0) || !(to.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d a = from.hnormalized(), b = to.hnormalized();
  const double length_px = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length_px;
  // d(image) / d(board) at the middle, along the way to the paper.
  const Eigen::Vector3d middle = 0.5 * (from + to), step = h.leftCols<2>() * edge.paper;
  const Eigen::Vector2d to_paper = (step.head<2>() - step.z() * middle.hnormalized()) / middle.z();
  OutlineImage out;
  out.normal = Eigen::Vector2d(-along.y(), along.x());
  if (out.normal.dot(to_paper) < 0.0) out.normal = -out.normal;
  const double px_per_m = out.normal.dot(to_paper);
  const double room = std::min(edge.ink_m / kMinInk_px, edge.paper_m / kMinPaper_px) * px_per_m;
  if (room < kSmallestScale) return std::nullopt;  // saves time: bits are many
  const std::optional<SensorPlace> place = sensorPlace(scene, 0.5 * (a + b));
  if (!place || room < place->scale) return std::nullopt;
  const double begin_px = gap_from_px * place->scale, end_px = length_px - gap_to_px * place->scale;
  if (!(end_px - begin_px > kShortest_px * place->scale)) return std::nullopt;
  out.max_radius_px = 0.5 * (end_px - begin_px);
  out.centre_px = a + 0.5 * (begin_px + end_px) * along;
  out.sensor_radius_px = out.max_radius_px / place->scale;
  const Eigen::Matrix2d px_per_ideal = place->ideal_per_px.inverse();
  out.sensor_centre_px = place->at_px + px_per_ideal * (out.centre_px - 0.5 * (a + b));
  out.sensor_reach_px = (px_per_ideal * along * out.max_radius_px).cwiseAbs();
  out.sectors = std::clamp(static_cast<int>(2.0 * out.sensor_radius_px / kSector_px) + 1, 1, kOutlineSectors);
  return out;
}

}  // namespace

std::optional<OutlineImage> imageOfCircle(const Eigen::Matrix3d& h, const BoardScene& scene, int index) {
  const Eigen::Vector2d c = scene.board.point_m(index);
  const double r2 = scene.board.radius_m * scene.board.radius_m;
  Eigen::Matrix3d dual;
  dual << c.x() * c.x() - r2, c.x() * c.y(), c.x(), c.x() * c.y(), c.y() * c.y() - r2, c.y(), c.x(), c.y(),
      1.0;
  const Eigen::Matrix3d q = h * dual * h.transpose();
  if (!((h * Eigen::Vector3d(c.x(), c.y(), 1.0)).z() > 0.0) || !(q(2, 2) > 0.0)) return std::nullopt;
  OutlineImage out;
  out.index = index;
  out.centre_px = q.topRightCorner<2, 1>() / q(2, 2);
  // Dual conic about its own centre: minus the matrix of squared semi-axes.
  const Eigen::Matrix2d axes2 = out.centre_px * out.centre_px.transpose() - q.topLeftCorner<2, 2>() / q(2, 2);
  const double det = axes2.determinant();
  if (!(det > 0.0) || !(axes2.trace() > 0.0)) return std::nullopt;
  out.shape = axes2.inverse();
  const double half_trace = 0.5 * axes2.trace();
  out.max_radius_px = std::sqrt(half_trace + std::sqrt(std::max(half_trace * half_trace - det, 0.0)));
  const std::optional<SensorPlace> place = sensorPlace(scene, out.centre_px);
  if (!place) return std::nullopt;
  out.sensor_centre_px = place->at_px;
  out.sensor_radius_px = out.max_radius_px / place->scale;
  out.sensor_reach_px.setConstant(out.sensor_radius_px);
  return out;
}

std::vector<OutlineImage> projectBoard(const Eigen::Matrix3d& ideal_from_board, const BoardScene& scene) {
  std::vector<OutlineImage> outlines;
  const int count = scene.outlineCount();
  for (int i = 0; i < count; ++i) {
    std::optional<OutlineImage> outline;
    if (scene.edges)
      outline = imageOfEdge(ideal_from_board, scene, scene.edges->edges[static_cast<std::size_t>(i)],
                            cornerGap_px(scene), cornerGap_px(scene));
    else
      outline = imageOfCircle(ideal_from_board, scene, i);
    if (!outline || !touchesImage(*outline, scene.resolution_px)) continue;
    outline->index = i;
    outlines.push_back(*outline);
  }
  return outlines;
}

std::vector<Eigen::Vector2d> outlinePoints(const OutlineImage& outline) {
  if (outline.isStraight()) {
    const Eigen::Vector2d half = outline.max_radius_px * outline.normal.unitOrthogonal();
    return {outline.centre_px - half, outline.centre_px + half};
  }
  constexpr int kPoints = 48;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(outline.shape);
  const Eigen::Matrix2d axes =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < kPoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kPoints;
    points.emplace_back(outline.centre_px + axes * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

std::optional<PointImage> imageOfPoint(const Eigen::Matrix3d& h, const BoardScene& scene, int index) {
  PointImage out;
  out.point = index;
  if (!scene.edges) {
    const std::optional<OutlineImage> circle = imageOfCircle(h, scene, index);
    if (!circle || !touchesImage(*circle, scene.resolution_px)) return std::nullopt;
    out.centre_px = circle->centre_px;
    out.sensor_centre_px = circle->sensor_centre_px;
    out.scale = circle->scale();
    out.outlines[0] = *circle;
    out.shown[0] = true;
    return out;
  }
  out.is_corner = true;
  const Eigen::Vector3d corner = h * scene.board.point_m(index).homogeneous();
  if (!(corner.z() > 0.0)) return std::nullopt;
  out.centre_px = corner.hnormalized();
  const std::optional<SensorPlace> place = sensorPlace(scene, out.centre_px);
  if (!place) return std::nullopt;
  out.sensor_centre_px = place->at_px;
  out.scale = place->scale;
  if (!insideImage(out, scene.resolution_px)) return std::nullopt;
  const auto& arms = scene.edges->arms[static_cast<std::size_t>(index)];
  for (std::size_t k = 0; k < arms.size(); ++k) {
    const std::optional<OutlineImage> arm = imageOfEdge(h, scene, arms[k], cornerGap_px(scene), 0.0);
    out.shown[k] = arm.has_value();
    if (arm) out.outlines[k] = *arm;
  }
  return out;
}

double narrowestInk_px(const Eigen::Matrix3d& h, const BoardScene& scene) {
  std::vector<double> widths_px;
  for (int index = 0; index < scene.board.pointCount(); ++index) {
    const Eigen::Vector3d corner = h * scene.board.point_m(index).homogeneous();
    if (!(corner.z() > 0.0)) continue;
    const Eigen::Vector2d at = corner.hnormalized();
    const std::optional<SensorPlace> place = sensorPlace(scene, at);
    if (!place) continue;
    double ink_m = std::numeric_limits<double>::infinity();
    for (const PrintedEdge& arm : scene.edges->arms[static_cast<std::size_t>(index)])
      ink_m = std::min(ink_m, arm.ink_m);
    const Eigen::Matrix2d px_per_m =
        (h.topLeftCorner<2, 2>() - at * h.block<1, 2>(2, 0)) / corner.z() / place->scale;
    widths_px.push_back(ink_m * std::sqrt(std::abs(px_per_m.determinant())));
  }
  return medianOf(std::move(widths_px));
}

bool insideImage(const OutlineImage& circle, Resolution resolution_px) {
  const double r = circle.sensor_radius_px;
  const Eigen::Vector2d& c = circle.sensor_centre_px;
  return c.x() >= r && c.y() >= r && c.x() <= resolution_px.width_px - 1 - r &&
         c.y() <= resolution_px.height_px - 1 - r;
}

bool insideImage(const PointImage& point, Resolution resolution_px) {
  if (!point.is_corner) return insideImage(point.outlines[0], resolution_px);
  constexpr double kMargin_px = kCornerGap_px + kShortest_px;
  const Eigen::Vector2d& c = point.sensor_centre_px;
  return c.x() >= kMargin_px && c.y() >= kMargin_px && c.x() <= resolution_px.width_px - 1 - kMargin_px &&
         c.y() <= resolution_px.height_px - 1 - kMargin_px;
}

}  // namespace evical
