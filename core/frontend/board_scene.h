// Constants of all windows: the board, the sensor, and the lens between them.
#pragma once

#include "core/frontend/detection_options.h"
#include "core/geometry/board.h"

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/printed_pattern.h"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace evical {

// Stretch of a pixel by lens distortion: J J^T of J = d(ideal pixel) / d(pixel).
struct PixelStretch {
  float xx = 1.0f, xy = 0.0f, yy = 1.0f;

  // Ideal pixels per pixel for an edge with this normal (unit, in ideal pixels): |J^T n|.
  double across(const Eigen::Vector2d& normal) const {
    const double x = normal.x(), y = normal.y();
    return std::sqrt(x * x * xx + 2.0 * x * y * xy + y * y * yy);
  }
};

// The lens, pixel by pixel.
struct IdealPixels {
  UndistortionTable ideal;
  std::vector<PixelStretch> stretch;
};

// Distance to the nearest edge of each direction, in cells.
class EdgeMap {
 public:
  // Directions of the paper. The opposite one differs in the last bit.
  static constexpr int kPlusX = 0, kMinusX = 1, kPlusY = 2, kMinusY = 3;

  explicit EdgeMap(const std::vector<PrintedEdge>& edges);

  bool contains(const Eigen::Vector2d& at_m) const {
    return (at_m.array() >= low_m_.array()).all() && (at_m.array() < high_m_.array()).all();
  }
  // The same for a larger map, by the share `beyond` of its size on each side.
  bool isAround(const Eigen::Vector2d& at_m, double beyond) const {
    const Eigen::Array2d margin_m = beyond * (high_m_ - low_m_).array();
    return (at_m.array() >= low_m_.array() - margin_m).all() &&
           (at_m.array() < high_m_.array() + margin_m).all();
  }
  // Infinite beyond the map, and beyond half of the smallest distance between edges.
  double distance_m(const Eigen::Vector2d& at_m, int direction) const {
    if (!contains(at_m)) return std::numeric_limits<double>::infinity();
    const Eigen::Vector2d cell = (at_m - low_m_) / cell_m_;
    const std::uint8_t cells =
        cells_[static_cast<std::size_t>(direction)]
              [static_cast<std::size_t>(static_cast<int>(cell.y()) * columns_ + static_cast<int>(cell.x()))];
    return cells == kNone ? std::numeric_limits<double>::infinity() : (cells + 0.5) * cell_m_;
  }

 private:
  static constexpr std::uint8_t kNone = 255;

  void draw(const PrintedEdge& edge);

  Eigen::Vector2d low_m_, high_m_;
  double cell_m_ = 0.0;
  int columns_ = 0, rows_ = 0, reach_ = 0;
  std::array<std::vector<std::uint8_t>, 4> cells_;  // by direction
};

// The edges of a board of squares: the table on which tracking, measuring and placing such a board depend.
struct BoardEdges {
  PrintedPattern pattern;
  std::vector<PrintedEdge> edges;
  // By point of the board: the edges that meet there, towards +x, -x, +y and -y, each from the point to half
  // its length.
  std::vector<std::array<PrintedEdge, 4>> arms;
  EdgeMap map;
  TagPrint print;

  BoardEdges(const Board& board, const TagPrint& print);
};
// The same for several scenes: the tables of the last boards are kept.
std::shared_ptr<const BoardEdges> edgesOf(const Board& board, const TagPrint& print);

// Copies are cheap: they share the tables of lens and edges.
struct BoardScene {
  Board board;
  Resolution resolution_px;
  std::optional<CameraIntrinsics> camera;
  std::shared_ptr<const IdealPixels> pixels;  // null without a camera: ideal pixels are the sensor's own
  std::shared_ptr<const BoardEdges> edges;    // null for circles
  bool print_known = false;                   // the edges are of the print, and no other one is tried
  bool single_events = false;                 // windows contain crossings that are too few for a burst

  BoardScene(const Board& board, Resolution resolution_px, std::optional<CameraIntrinsics> camera);

  int outlineCount() const { return edges ? static_cast<int>(edges->edges.size()) : board.pointCount(); }
};

// Bursts of a board: of a checkerboard, whose lattice is found in single events, those are needed, too.
inline BurstOptions burstsFor(const Board& board, BurstOptions options) {
  options.single_events = board.type == BoardType::Checkerboard;
  return options;
}

}  // namespace evical
