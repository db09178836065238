#include "core/base/error.h"
#include "core/frames/board_finder.h"
#include "core/frames/corner_measurement.h"
#include "core/frames/gray_image.h"
#include "core/frames/picture_view.h"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>

namespace evical {
namespace {

// Inner corners, row by row: of the whole board, or of the visible part.
struct Grid {
  int rows = 0, cols = 0;
  std::vector<Eigen::Vector2d> corners;

  Eigen::Vector2d& at(int row, int col) { return corners[static_cast<std::size_t>(row * cols + col)]; }
};

// Searches are slow in large pictures, and usually do not need full resolution.
constexpr std::array<int, 2> kSearchedSides_px = {400, 800};
constexpr int kShortestSide_px = 300;  // smaller pictures are enlarged

// OpenCV may count the rows from either end, which can result in a mirrored board.
void putRight(Grid& grid) {
  const Eigen::Vector2d x = grid.at(0, grid.cols - 1) - grid.at(0, 0);
  const Eigen::Vector2d y = grid.at(grid.rows - 1, 0) - grid.at(0, 0);
  if (x.x() * y.y() - x.y() * y.x() > 0.0) return;
  for (int row = 0; row < grid.rows / 2; ++row)
    for (int col = 0; col < grid.cols; ++col) std::swap(grid.at(row, col), grid.at(grid.rows - 1 - row, col));
}

Grid gridOf(const std::vector<cv::Point2f>& corners, int rows, int cols) {
  Grid grid{rows, cols, {}};
  for (const cv::Point2f& corner : corners) grid.corners.emplace_back(corner.x, corner.y);
  putRight(grid);
  return grid;
}

std::optional<Grid> searchIn(const cv::Mat& picture, const Board& board) {
  const cv::Size size(board.cols, board.rows);
  std::vector<cv::Point2f> corners;
  bool found = false;
  if (std::min(size.width, size.height) > 2) {  // OpenCV does not support smaller boards
    found = cv::findChessboardCornersSB(picture, size, corners, cv::CALIB_CB_ACCURACY);
    if (!found)
      found = cv::findChessboardCorners(picture, size, corners,
                                        cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
  }
  if (!found || corners.size() != static_cast<std::size_t>(board.pointCount())) return std::nullopt;
  return gridOf(corners, board.rows, board.cols);
}

// The visible part of a checkerboard.
std::optional<Grid> searchPartIn(const cv::Mat& picture) {
  constexpr int kSmallest = 3;
  std::vector<cv::Point2f> corners;
  cv::Mat meta;
  const bool found = cv::findChessboardCornersSB(picture, {kSmallest, kSmallest}, corners,
                                                 cv::CALIB_CB_ACCURACY | cv::CALIB_CB_LARGER, meta);
  if (!found || meta.total() != corners.size()) return std::nullopt;
  return gridOf(corners, meta.rows, meta.cols);
}

// Searches at another size; places are those of the picture itself.
template <class Search>
std::optional<Grid> searchScaled(const cv::Mat& picture, double scale, const Search& search) {
  cv::Mat scaled;
  cv::resize(picture, scaled, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC);
  std::optional<Grid> grid = search(scaled);
  if (!grid) return grid;
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);  // pixels' centres are at integers
  for (Eigen::Vector2d& corner : grid->corners) corner = (corner + half) / scale - half;
  return grid;
}

template <class Search>
std::optional<Grid> searchAtSizes(const GrayImage& image, const Search& search) {
  const cv::Mat picture = viewOf(image);
  const int longest = std::max(picture.cols, picture.rows);
  if (longest < kShortestSide_px) return searchScaled(picture, 4.0, search);
  for (const int side : kSearchedSides_px) {
    if (longest <= side) continue;
    if (auto grid = searchScaled(picture, static_cast<double>(side) / longest, search)) return grid;
  }
  return search(picture);
}

Grid quarterTurned(Grid& grid) {
  Grid turned{grid.cols, grid.rows, {}};
  for (int row = 0; row < turned.rows; ++row)
    for (int col = 0; col < turned.cols; ++col) turned.corners.push_back(grid.at(grid.rows - 1 - col, row));
  return turned;
}

Grid beginningOf(Grid& grid, int rows, int cols) {
  Grid part{std::min(rows, grid.rows), std::min(cols, grid.cols), {}};
  for (int row = 0; row < part.rows; ++row)
    for (int col = 0; col < part.cols; ++col) part.corners.push_back(grid.at(row, col));
  return part;
}

class CheckerboardFinder : public PatternFinder {
 public:
  CheckerboardFinder(const Board& board, const FrameOptions& options, CheckerboardParts parts)
      : board_(board), options_(options), parts_(parts), pattern_(checkerboardCorners(board)) {
    if (std::min(board.rows, board.cols) < 3)
      throw badInput("board", "a checkerboard of fewer than 3 x 3 inner corners cannot be detected in frames",
                     "Use a board with more squares");
  }

  FoundPoints search(const GrayImage& image) override {
    FoundPoints rough;
    if (parts_ == CheckerboardParts::Any) rough = searchPart(image);
    const bool is_part = !rough.empty() && static_cast<int>(rough.size()) < board_.pointCount();
    if (rough.empty()) rough = searchWhole(image);
    const std::optional<PlaneMap> map = mapOf(rough, board_);
    if (!map) return {};
    FoundPoints found = measure(image, *map, options_.max_move_px);
    if (is_part) keepThoseOf(rough, found);  // beyond it there are no corners, or none were seen
    return found;
  }

  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const override {
    return measureCorners(image, board_, pattern_, map, gate_px, options_);
  }

  std::string doubt() const override {
    constexpr double kNowAndThen = 0.3;  // false lines are sometimes added
    return larger_ > kNowAndThen * parts_found_
               ? fmt::format(
                     "up to {} x {} inner corners of the checkerboard are visible, but the session has {} x "
                     "{}: check rows and columns",
                     largest_.rows, largest_.cols, board_.rows, board_.cols)
               : std::string();
  }

 private:
  FoundPoints searchWhole(const GrayImage& image) {
    std::optional<Grid> grid =
        searchAtSizes(image, [&](const cv::Mat& picture) { return searchIn(picture, board_); });
    if (!grid) return {};
    turnByShade(image, *grid);
    return numbered(*grid, 0, 0);
  }

  // Part at the board's beginning, or one row or column further, depending on the squares' brightness.
  FoundPoints searchPart(const GrayImage& image) {
    std::optional<Grid> grid = searchAtSizes(image, searchPartIn);
    if (!grid) return {};
    const bool lies = grid->rows <= board_.rows && grid->cols <= board_.cols;
    if (!lies && grid->cols <= board_.rows && grid->rows <= board_.cols) grid = quarterTurned(*grid);
    ++parts_found_;
    if (grid->rows > board_.rows || grid->cols > board_.cols) {
      ++larger_;
      if (grid->corners.size() > static_cast<std::size_t>(largest_.rows * largest_.cols))
        largest_ = {grid->rows, grid->cols};
      if (FoundPoints whole = searchWhole(image); !whole.empty()) return whole;
      grid = beginningOf(*grid, board_.rows, board_.cols);
    }
    if (shadeOf(image, *grid) >= 0.0) return numbered(*grid, 0, 0);
    if (grid->cols < board_.cols) return numbered(*grid, 0, 1);
    if (grid->rows < board_.rows) return numbered(*grid, 1, 0);
    turnByShade(image, *grid);
    return numbered(*grid, 0, 0);
  }

  FoundPoints numbered(Grid& grid, int first_row, int first_col) const {
    FoundPoints points;
    for (int row = 0; row < grid.rows; ++row)
      for (int col = 0; col < grid.cols; ++col) {
        FoundPoint& point = points.emplace_back();
        point.point = board_.index(first_row + row, first_col + col);
        point.at_px = grid.at(row, col);
      }
    return points;
  }

  // Mean brightness difference between bright and dark squares, if the grid's first corner is the board's.
  double shadeOf(const GrayImage& image, Grid& grid) const {
    std::array<double, 2> sums{}, counts{};
    for (int row = 0; row + 1 < grid.rows; ++row) {
      for (int col = 0; col + 1 < grid.cols; ++col) {
        const Eigen::Vector2d middle = 0.25 * (grid.at(row, col) + grid.at(row, col + 1) +
                                               grid.at(row + 1, col) + grid.at(row + 1, col + 1));
        if (!isInside(image, middle, 1.0)) continue;
        const std::size_t dark =
            pattern_.dark_ahead[static_cast<std::size_t>(board_.index(row, col))] ? 1 : 0;
        sums.at(dark) += brightnessAt(image, middle);
        counts.at(dark) += 1.0;
      }
    }
    return sums[0] / std::max(counts[0], 1.0) - sums[1] / std::max(counts[1], 1.0);
  }

  // Applies the half turn that puts a dark square before point 0; if both ends have bright squares, the
  // pattern is inverted instead.
  void turnByShade(const GrayImage& image, Grid& grid) {
    if (shadeOf(image, grid) >= 0.0) return;
    if (board_.hasHalfTurnAmbiguity())
      pattern_.dark_ahead.flip();
    else
      std::reverse(grid.corners.begin(), grid.corners.end());
  }

  struct Size {
    int rows = 0, cols = 0;
  };

  Board board_;
  FrameOptions options_;
  CheckerboardParts parts_;
  CornerPattern pattern_;
  int parts_found_ = 0, larger_ = 0;  // pictures with a part of the board, and with more than the board
  Size largest_;
};

}  // namespace

std::unique_ptr<PatternFinder> makeCheckerboardFinder(const Board& board, const FrameOptions& options,
                                                      CheckerboardParts parts) {
  return std::make_unique<CheckerboardFinder>(board, options, parts);
}

}  // namespace evical
