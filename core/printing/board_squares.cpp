#include "core/printing/board_squares.h"

#include "core/base/error.h"
#include "core/geometry/marker_bits.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

using Boxes = std::vector<PaintedBox>;

void paintSquare(const Eigen::Vector2d& corner_m, double size_m, Boxes& boxes) {
  boxes.push_back({corner_m, Eigen::Vector2d::Constant(size_m), false});
}

// Paints a dark square with its border, and on it the bright bits; neighbours in a row form one rectangle.
void paintTag(const Eigen::Vector2d& corner_m, double size_m, int border_bits, const PatternBits& bits,
              Boxes& boxes) {
  paintSquare(corner_m, size_m, boxes);
  const double bit_m = size_m / static_cast<double>(bits.size() + 2 * static_cast<std::size_t>(border_bits));
  for (std::size_t row = 0; row < bits.size(); ++row) {
    for (std::size_t begin = 0, end = 0; begin < bits.size(); begin = std::max(end, begin + 1)) {
      for (end = begin; end < bits.size() && bits[row][end];) ++end;
      if (end == begin) continue;
      const Eigen::Vector2d place(static_cast<double>(begin) + border_bits,
                                  static_cast<double>(row) + border_bits);
      boxes.push_back({corner_m + bit_m * place, {bit_m * static_cast<double>(end - begin), bit_m}, true});
    }
  }
}

Boxes checkerboard(const Board& board) {
  Boxes boxes;
  for (int row = -1; row < board.rows; ++row)
    for (int col = -1; col < board.cols; ++col)
      if ((row + col) % 2 == 0)
        paintSquare(board.spacing_m * Eigen::Vector2d(col, row), board.spacing_m, boxes);
  return boxes;
}

PatternBits bitsOf(const TagBits& tag) {
  PatternBits bits;
  for (int row = 0; row < kTagSide_bits; ++row) {
    bits.emplace_back();
    for (int col = 0; col < kTagSide_bits; ++col) bits.back().push_back(tag.isBright(row, col));
  }
  return bits;
}

Boxes tagGrid(const Board& board, int border_bits) {
  const int needed = board.rows * board.cols;
  const std::vector<TagBits> tags = firstTags(needed);
  if (needed > static_cast<int>(tags.size()))
    throw badInput("board", fmt::format("needs {} tags, but tag36h11 has {}", needed, tags.size()),
                   "Use fewer rows or columns");
  Boxes boxes;
  const double gap_m = board.spacing_m - board.tag_size_m;
  for (int row = -1; row < board.rows; ++row)
    for (int col = -1; col < board.cols; ++col)
      paintSquare(board.spacing_m * Eigen::Vector2d(col, row) + Eigen::Vector2d::Constant(board.tag_size_m),
                  gap_m, boxes);
  for (int row = 0; row < board.rows; ++row)
    for (int col = 0; col < board.cols; ++col)
      paintTag(board.spacing_m * Eigen::Vector2d(col, row), board.tag_size_m, border_bits,
               bitsOf(tags[static_cast<std::size_t>((board.rows - 1 - row) * board.cols + col)]), boxes);
  return boxes;
}

Boxes charuco(const Board& board, const std::string& markers) {
  const std::vector<BoardSquare> bright = charucoMarkers(board, false);
  const std::vector<PatternBits> bits = firstMarkers(markers, static_cast<int>(bright.size()));
  Boxes boxes;
  for (const BoardSquare& dark : charucoMarkers(board, true))
    paintSquare(squareCorner_m(board, dark), board.spacing_m, boxes);
  const double margin_m = 0.5 * (board.spacing_m - board.tag_size_m);
  for (std::size_t id = 0; id < bright.size(); ++id)
    paintTag(squareCorner_m(board, bright[id]) + Eigen::Vector2d::Constant(margin_m), board.tag_size_m, 1,
             bits[id], boxes);
  return boxes;
}

// Dots at the points of a board without a pattern: only their positions are known.
std::vector<PaintedBox> dots(const Board& board) {
  constexpr double kOfSpacing = 0.15;
  std::vector<PaintedBox> boxes;
  const double size_m = kOfSpacing * board.spacing_m;
  for (const Eigen::Vector2d& point_m : board.given_m)
    paintSquare(point_m - Eigen::Vector2d::Constant(0.5 * size_m), size_m, boxes);
  return boxes;
}

}  // namespace

std::vector<PaintedBox> boardSquares(const Board& board, const TagPrint& print) {
  switch (board.type) {
    case BoardType::Checkerboard:
      return checkerboard(board);
    case BoardType::AprilGrid:
      return tagGrid(board, print.border_bits);
    case BoardType::Charuco:
      return charuco(board, print.markers);
    case BoardType::Points:
      return dots(board);
    default:
      return {};
  }
}

}  // namespace evical
