// Measurement of corners near their expected places.
#pragma once

#include "core/frames/frame_options.h"
#include "core/frames/gray_image.h"
#include "core/frames/plane_map.h"

#include "core/geometry/board.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

// Curvature of the board's lines in a picture by a wide lens, from the points detected on them.

// Near a point, a line follows p = tangent s + normal curvature s^2 / 2.
struct BentLine {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double curvature_1_px = 0.0;
};

class BentLines {
 public:
  BentLines(const FoundPoints& found, const Board& board);

  // The lines along the board's rows and columns through the detected point of this index: a quadratic map of
  // the board's plane, fitted to the points around it. Empty if there are too few.
  std::optional<std::array<BentLine, 2>> through(std::size_t index) const;

 private:
  struct Neighbours {
    std::vector<Eigen::Vector2d> on_board_m, in_picture_px;  // the nearest first: the point itself
  };
  Neighbours around(std::size_t index) const;

  std::vector<Eigen::Vector2d> on_board_m_, in_picture_px_;
  double step_m_;
};

// Surroundings of the corners of a board without circles.

// Around each corner, two diagonal fields are dark, and the other two are bright.
struct CornerPattern {
  double plain_m = 0.0;          // within this distance along both axes, the corner is the only feature
  std::vector<bool> dark_ahead;  // by point: true if the fields towards +x +y and -x -y are dark
};

// The square before point 0 of a checkerboard, towards -x -y, is dark.
CornerPattern checkerboardCorners(const Board& board);
CornerPattern tagGridCorners(const Board& board, int border_bits);
// The board's top left square is dark, unless `first_is_bright`.
CornerPattern charucoCorners(const Board& board, bool first_is_bright);

struct MeasuredCorner {
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();  // of the picture's noise alone
};

// The place from which every offset within a window is perpendicular to the gradient there (W. Forstner and
// E. Gulch, 1987; OpenCV's cornerSubPix), weighted by distance. Empty if the iteration leaves the window or
// the picture, or if there are not two edges.
std::optional<MeasuredCorner> measureCorner(const GrayImage& image, const Eigen::Vector2d& start_px,
                                            double half_width_px, double noise_sigma);

// Offset between that place and a corner of curved lines. At s along an edge p of normal n(s), n(s) . p(s) is
// not 0 but -curvature s^2 / 2.
Eigen::Vector2d shiftByBending(const GrayImage& image, const Eigen::Vector2d& at_px, double half_width_px,
                               const std::array<BentLine, 2>& lines);

// All visible corners within `gate_px` of their places according to the map that have dark and bright fields
// as in the pattern.
FoundPoints measureCorners(const GrayImage& image, const Board& board, const CornerPattern& pattern,
                           const PlaneMap& map, double gate_px, const FrameOptions& options);

// Measurement of corners in pictures with systematic differences between pixels: counts of flashes, which
// depend on each pixel's thresholds.

// The smoothed brightness has a saddle where two dark and two bright fields meet. It is at the corner for any
// tones, since a half turn about the corner leaves the pattern unchanged. Empty if there is no saddle within
// `reach_px` of the start. `noise_sigma` is a pixel's noise, correlated over `correlated_px`, which is the
// enlargement factor of an enlarged picture.
std::optional<MeasuredCorner> measureSaddle(const GrayImage& image, const Eigen::Vector2d& start_px,
                                            double sigma_px, double reach_px, double noise_sigma,
                                            double correlated_px);

}  // namespace evical
