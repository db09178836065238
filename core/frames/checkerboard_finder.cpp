#include "core/base/error.h"
#include "core/frames/brightness.h"
#include "core/frames/corner_measurement.h"
#include "core/frames/pattern_finder.h"
#include "core/frames/picture_view.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>

namespace evical {
namespace {

using Grid = std::vector<Eigen::Vector2d>;  // by Board::index

// Searches are slow in large pictures, and mostly need none of their detail.
constexpr std::array<int, 2> kSearchedSides_px = {400, 800};
constexpr int kShortestSide_px = 300;  // smaller pictures are enlarged

Eigen::Vector2d& at(Grid& grid, const Board& board, int row, int col) {
  return grid[static_cast<std::size_t>(board.index(row, col))];
}

// OpenCV may count the rows from either end, and then sees a mirrored board.
void putRight(Grid& grid, const Board& board) {
  const Eigen::Vector2d x = at(grid, board, 0, board.cols - 1) - at(grid, board, 0, 0);
  const Eigen::Vector2d y = at(grid, board, board.rows - 1, 0) - at(grid, board, 0, 0);
  if (x.x() * y.y() - x.y() * y.x() > 0.0) return;
  for (int row = 0; row < board.rows / 2; ++row)
    for (int col = 0; col < board.cols; ++col)
      std::swap(at(grid, board, row, col), at(grid, board, board.rows - 1 - row, col));
}

std::optional<Grid> searchIn(const cv::Mat& picture, const Board& board) {
  const cv::Size size(board.cols, board.rows);
  std::vector<cv::Point2f> corners;
  bool found = false;
  if (std::min(size.width, size.height) > 2) {  // OpenCV knows no smaller boards
    found = cv::findChessboardCornersSB(picture, size, corners, cv::CALIB_CB_ACCURACY);
    if (!found)
      found = cv::findChessboardCorners(picture, size, corners,
                                        cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
  }
  if (!found || corners.size() != static_cast<std::size_t>(board.pointCount())) return std::nullopt;
  Grid grid;
  for (const cv::Point2f& corner : corners) grid.emplace_back(corner.x, corner.y);
  putRight(grid, board);
  return grid;
}

// At another size; places are those of the picture itself.
std::optional<Grid> searchScaled(const cv::Mat& picture, double scale, const Board& board) {
  cv::Mat scaled;
  cv::resize(picture, scaled, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC);
  std::optional<Grid> grid = searchIn(scaled, board);
  if (!grid) return grid;
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);  // pixels' centres are at whole numbers
  for (Eigen::Vector2d& corner : *grid) corner = (corner + half) / scale - half;
  return grid;
}

class CheckerboardFinder : public PatternFinder {
 public:
  CheckerboardFinder(const Board& board, const FrameOptions& options)
      : board_(board), options_(options), pattern_(checkerboardCorners(board)) {
    if (std::min(board.rows, board.cols) < 3)
      throw badInput("board", "a checkerboard of fewer than 3 x 3 inner corners is not found in frames",
                     "Use a board with more squares");
  }

  FoundPoints search(const GrayImage& image) override {
    std::optional<Grid> grid = searchAtSizes(image);
    if (!grid) return {};
    turnByShade(image, *grid);
    FoundPoints rough;
    for (const Eigen::Vector2d& corner : *grid) {
      FoundPoint& point = rough.emplace_back();
      point.point = static_cast<int>(rough.size()) - 1;
      point.at_px = corner;
    }
    const std::optional<PlaneMap> map = mapOf(rough, board_);
    return map ? measure(image, *map, options_.largest_move_px) : FoundPoints{};
  }

  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const override {
    return measureCorners(image, board_, pattern_, map, gate_px, options_);
  }

 private:
  std::optional<Grid> searchAtSizes(const GrayImage& image) const {
    const cv::Mat picture = viewOf(image);
    const int longest = std::max(picture.cols, picture.rows);
    if (longest < kShortestSide_px) return searchScaled(picture, 4.0, board_);
    for (const int side : kSearchedSides_px) {
      if (longest <= side) continue;
      if (auto grid = searchScaled(picture, static_cast<double>(side) / longest, board_)) return grid;
    }
    return searchIn(picture, board_);
  }

  // How much darker the squares are that should be.
  double shadeOf(const GrayImage& image, Grid& grid) const {
    std::array<double, 2> sums{}, counts{};
    for (int row = 0; row + 1 < board_.rows; ++row) {
      for (int col = 0; col + 1 < board_.cols; ++col) {
        const Eigen::Vector2d middle =
            0.25 * (at(grid, board_, row, col) + at(grid, board_, row, col + 1) +
                    at(grid, board_, row + 1, col) + at(grid, board_, row + 1, col + 1));
        if (!isInside(image, middle, 1.0)) continue;
        const std::size_t dark =
            pattern_.dark_ahead[static_cast<std::size_t>(board_.index(row, col))] ? 1 : 0;
        sums.at(dark) += brightnessAt(image, middle);
        counts.at(dark) += 1.0;
      }
    }
    return sums[0] / std::max(counts[0], 1.0) - sums[1] / std::max(counts[1], 1.0);
  }

  // The half turn that puts a dark square before point 0; of a board that has bright ones before both ends the
  // pattern is the other.
  void turnByShade(const GrayImage& image, Grid& grid) {
    if (shadeOf(image, grid) >= 0.0) return;
    if (board_.hasHalfTurnAmbiguity())
      pattern_.dark_ahead.flip();
    else
      std::reverse(grid.begin(), grid.end());
  }

  Board board_;
  FrameOptions options_;
  CornerPattern pattern_;
};

}  // namespace

std::unique_ptr<PatternFinder> makeCheckerboardFinder(const Board& board, const FrameOptions& options) {
  return std::make_unique<CheckerboardFinder>(board, options);
}

}  // namespace evical
