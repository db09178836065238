// Images of what the board shows: the outlines of its circles, or the straight edges of its squares. Tracking
// and measuring compare bursts with outlines, and need of them only a distance and a normal.
#pragma once

#include "core/frontend/board_scene.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

constexpr int kOutlineSectors = 16;

// The ellipse of a circle, {q : (q - centre)^T shape (q - centre) = 1}, or a straight edge, in ideal pixels.
struct OutlineImage {
  int index = 0;                                        // of the circle, or of the edge in the scene's table
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // of an edge: its middle
  Eigen::Matrix2d shape = Eigen::Matrix2d::Identity();  // of a circle
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();     // of an edge: unit, towards the paper; circles: zero
  double max_radius_px = 0.0;                           // of an edge: half its length
  Eigen::Vector2d sensor_centre_px = Eigen::Vector2d::Zero();  // in the sensor's own pixels
  double sensor_radius_px = 0.0;
  Eigen::Vector2d sensor_reach_px = Eigen::Vector2d::Zero();  // along x and y
  int sectors = kOutlineSectors;                              // of an edge: parts of its length

  bool isStraight() const { return normal.x() != 0.0 || normal.y() != 0.0; }
  // Ideal pixels per pixel of the sensor.
  double scale() const { return max_radius_px / sensor_radius_px; }
};
std::optional<OutlineImage> imageOfCircle(const Eigen::Matrix3d& ideal_from_board, const BoardScene& scene,
                                          int circle);

// The circles, or the edges, that touch the image. Edges that are too short, or too near to a parallel one,
// for separate bursts are left out.
std::vector<OutlineImage> projectBoard(const Eigen::Matrix3d& ideal_from_board, const BoardScene& scene);

// For drawings, in ideal pixels: a closed polygon around a circle, or the two ends of an edge.
std::vector<Eigen::Vector2d> outlinePoints(const OutlineImage& outline);

// A burst compared with a projected outline.
struct EdgeDistance {
  double distance_px;      // from the ink outwards positive, ideal pixels; NaN beyond the ends of an edge
  Eigen::Vector2d normal;  // outwards, unit
};
inline EdgeDistance distanceToEdge(const OutlineImage& outline, const Eigen::Vector2d& ideal_pixel) {
  const Eigen::Vector2d from_centre = ideal_pixel - outline.centre_px;
  if (outline.isStraight()) {
    const Eigen::Vector2d& n = outline.normal;
    const double along_px = n.x() * from_centre.y() - n.y() * from_centre.x();
    return {std::abs(along_px) < outline.max_radius_px ? n.dot(from_centre) : NAN, n};
  }
  const Eigen::Vector2d gradient = outline.shape * from_centre;
  const double slope = gradient.norm();
  if (slope < 1e-12) return {-outline.max_radius_px, Eigen::Vector2d::UnitX()};
  const double level = std::sqrt(std::max(from_centre.dot(gradient), 1e-12));
  return {level * (level - 1.0) / slope, gradient / slope};
}

// Sector of a normal of any length, without computing an angle; sectors of 22.5 degrees, numbered.
inline std::size_t outlineSector(const Eigen::Vector2d& normal) {
  constexpr double kTan22 = 0.41421356237309503;
  const double ax = std::abs(normal.x()), ay = std::abs(normal.y());
  const std::size_t part = ay < ax ? (ay < kTan22 * ax ? 0 : 1) : (ax < kTan22 * ay ? 3 : 2);
  return part + (normal.x() < 0.0 ? 4 : 0) + (normal.y() < 0.0 ? 8 : 0);
}

// Sector of an outline that a burst at its edge belongs to: normals, or places along an edge, are about
// equal.
inline std::size_t sectorOf(const OutlineImage& outline, const Eigen::Vector2d& normal,
                            const Eigen::Vector2d& ideal_pixel) {
  if (!outline.isStraight()) return outlineSector(normal);
  const Eigen::Vector2d from_centre = ideal_pixel - outline.centre_px;
  const double along_px = normal.x() * from_centre.y() - normal.y() * from_centre.x();
  const int sector = static_cast<int>(0.5 * (along_px / outline.max_radius_px + 1.0) * outline.sectors);
  return static_cast<std::size_t>(std::clamp(sector, 0, outline.sectors - 1));
}

// A point of the board: one circle, or the four edges that meet at a corner, each from the corner to half its
// length: neighbouring corners do not share bursts.
struct PointImage {
  int point = 0;
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero(), sensor_centre_px = Eigen::Vector2d::Zero();
  double scale = 1.0;  // ideal pixels per pixel of the sensor
  bool is_corner = false;
  std::array<OutlineImage, 4> outlines;
  std::array<bool, 4> shown = {};  // of a corner: in the order of BoardEdges::arms; of a circle: the first
};
std::optional<PointImage> imageOfPoint(const Eigen::Matrix3d& ideal_from_board, const BoardScene& scene,
                                       int point);

// Narrowest dark line next to the edges of a board's corners in the image, in the sensor's pixels: median;
// and the limit below which such edges are left out.
double narrowestInk_px(const Eigen::Matrix3d& ideal_from_board, const BoardScene& scene);
inline constexpr double kMinInk_px = 3.0;

// True if the whole circle, or the corner and its closest surroundings, are in the image.
bool insideImage(const PointImage& point, Resolution resolution_px);
bool insideImage(const OutlineImage& circle, Resolution resolution_px);

}  // namespace evical
