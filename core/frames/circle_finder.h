// Measurement of circles near their expected places: ellipses fitted to their edges.
#pragma once

#include "core/frames/frame_options.h"
#include "core/frames/gray_image.h"
#include "core/frames/plane_map.h"
#include "core/geometry/board.h"

#include <optional>

namespace evical {

struct Ellipse {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d from_unit_circle = Eigen::Matrix2d::Identity();
};

struct MeasuredEllipse {
  Ellipse ellipse;
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();  // of the centre
};

// Edge points are at the steepest change of brightness along normals of the expected ellipse, within
// `reach_px` of it. Empty if too little of the ellipse is visible.
std::optional<MeasuredEllipse> measureEllipse(const GrayImage& image, const Ellipse& expected,
                                              double reach_px, CircleShade shade, double min_contrast);

// All circles within `gate_px` of their places according to the map.
FoundPoints measureCircles(const GrayImage& image, const Board& board, const PlaneMap& map, double gate_px,
                           const FrameOptions& options);

}  // namespace evical
