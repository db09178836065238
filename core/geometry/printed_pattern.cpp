#include "core/geometry/printed_pattern.h"

#include "core/base/error.h"
#include "core/geometry/marker_bits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

Boxes tagGrid(const Board& board, const TagPrint& print) {
  const int needed = board.first_tag + board.rows * board.cols;
  const std::vector<PatternBits> tags = firstTags(print.blank ? 0 : needed);
  if (!print.blank && needed > static_cast<int>(tags.size()))
    throw badInput("board", fmt::format("needs tags up to {}, but tag36h11 has {}", needed - 1, tags.size()),
                   "Use fewer rows or columns, or a smaller number of the first tag");
  Boxes boxes;
  const double gap_m = board.spacing_m - board.tag_size_m;
  for (int row = -1; row < board.rows; ++row)
    for (int col = -1; col < board.cols; ++col)
      paintSquare(board.spacing_m * Eigen::Vector2d(col, row) + Eigen::Vector2d::Constant(board.tag_size_m),
                  gap_m, boxes);
  for (int k = 0; k < board.rows * board.cols; ++k) {
    const int square = squareOf(board, print.order, k);
    const Eigen::Vector2d place(square % board.cols, board.rows - 1 - square / board.cols);
    const auto tag = static_cast<std::size_t>(board.first_tag + k);
    const PatternBits bits = print.blank ? PatternBits() : turned(tags[tag], print.quarter_turns);
    paintTag(board.spacing_m * place, board.tag_size_m, print.border_bits, bits, boxes);
  }
  return boxes;
}

Boxes charuco(const Board& board, const TagPrint& print) {
  const std::vector<BoardSquare> bright = charucoMarkers(board, print.first_is_bright);
  const std::vector<PatternBits> bits =
      firstMarkers(print.markers, print.blank ? 0 : static_cast<int>(bright.size()));
  Boxes boxes;
  for (const BoardSquare& dark : charucoMarkers(board, !print.first_is_bright))
    paintSquare(squareCorner_m(board, dark), board.spacing_m, boxes);
  const double margin_m = 0.5 * (board.spacing_m - board.tag_size_m);
  for (std::size_t id = 0; id < bright.size() && !print.blank; ++id)
    paintTag(squareCorner_m(board, bright[id]) + Eigen::Vector2d::Constant(margin_m), board.tag_size_m, 1,
             turned(bits[id], print.quarter_turns), boxes);
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
      return tagGrid(board, print);
    case BoardType::Charuco:
      return charuco(board, print);
    case BoardType::Points:
      return dots(board);
    default:
      return {};
  }
}

namespace {

constexpr double kSameLine = 1e-6;  // of the spacing

std::vector<double> distinct(std::vector<double> values, double tolerance) {
  std::sort(values.begin(), values.end());
  const auto same = [&](double a, double b) { return b - a < tolerance; };
  values.erase(std::unique(values.begin(), values.end(), same), values.end());
  return values;
}

// Cell that begins at or before a value; -1 before the first line.
int cellOf(const std::vector<double>& lines, double value) {
  return static_cast<int>(std::upper_bound(lines.begin(), lines.end(), value) - lines.begin()) - 1;
}

}  // namespace

PrintedPattern::PrintedPattern(const Board& board, const TagPrint& print) {
  const Boxes boxes = boardSquares(board, print);
  for (const PaintedBox& box : boxes) {
    x_m_.insert(x_m_.end(), {box.corner_m.x(), box.corner_m.x() + box.size_m.x()});
    y_m_.insert(y_m_.end(), {box.corner_m.y(), box.corner_m.y() + box.size_m.y()});
  }
  const double tolerance_m = kSameLine * board.spacing_m;
  x_m_ = distinct(std::move(x_m_), tolerance_m);
  y_m_ = distinct(std::move(y_m_), tolerance_m);
  if (boxes.empty()) return;
  ink_.assign(static_cast<std::size_t>(columns() * rows()), false);
  for (const PaintedBox& box : boxes) {
    const Eigen::Vector2d low = box.corner_m.array() + tolerance_m,
                          high = (box.corner_m + box.size_m).array() - tolerance_m;
    for (int row = cellOf(y_m_, low.y()); row <= cellOf(y_m_, high.y()); ++row)
      for (int column = cellOf(x_m_, low.x()); column <= cellOf(x_m_, high.x()); ++column)
        ink_[static_cast<std::size_t>(row * columns() + column)] = !box.bright;
  }
}

bool PrintedPattern::inkAt(int column, int row) const {
  return column >= 0 && row >= 0 && column < columns() && row < rows() &&
         ink_[static_cast<std::size_t>(row * columns() + column)];
}

bool PrintedPattern::isInk(const Eigen::Vector2d& at_m) const {
  return inkAt(cellOf(x_m_, at_m.x()), cellOf(y_m_, at_m.y()));
}

std::vector<PaintedBox> PrintedPattern::inkBoxes() const {
  std::vector<PaintedBox> boxes;
  for (int row = 0; row < rows(); ++row) {
    const double y_m = y_m_[static_cast<std::size_t>(row)],
                 height_m = y_m_[static_cast<std::size_t>(row) + 1] - y_m;
    for (int begin = 0, end = 0; begin < columns(); begin = std::max(end, begin + 1)) {
      for (end = begin; inkAt(end, row);) ++end;
      if (end == begin) continue;
      const double x_m = x_m_[static_cast<std::size_t>(begin)];
      boxes.push_back({{x_m, y_m}, {x_m_[static_cast<std::size_t>(end)] - x_m, height_m}, false});
    }
  }
  return boxes;
}

// Vertical edges; horizontal ones are those of the transposed pattern.
void PrintedPattern::addEdges(bool vertical, std::vector<PrintedEdge>& edges) const {
  const std::vector<double>&across = vertical ? x_m_ : y_m_, &along = vertical ? y_m_ : x_m_;
  const int lines = static_cast<int>(across.size()), cells = static_cast<int>(along.size()) - 1;
  const auto ink = [&](int line, int cell) { return vertical ? inkAt(line, cell) : inkAt(cell, line); };
  const auto placeOf = [&](int line) { return across[static_cast<std::size_t>(line)]; };
  // Distance from a line to the next change of shade, in one direction.
  const auto roomFrom = [&](int line, int cell, int step) {
    const bool shade = ink(step > 0 ? line : line - 1, cell);
    for (int next = line + step; next >= 0 && next < lines; next += step)
      if (ink(step > 0 ? next : next - 1, cell) != shade) return std::abs(placeOf(next) - placeOf(line));
    return std::numeric_limits<double>::infinity();
  };
  for (int line = 0; line < lines; ++line) {
    int side_before = 0;  // of the paper; 0: no edge
    for (int cell = 0; cell < cells; ++cell) {
      const bool before = ink(line - 1, cell), after = ink(line, cell);
      const int side = before == after ? 0 : (before ? 1 : -1);
      const double begin_m = along[static_cast<std::size_t>(cell)],
                   end_m = along[static_cast<std::size_t>(cell) + 1];
      const double ink_m = side == 0 ? 0.0 : roomFrom(line, cell, -side),
                   paper_m = side == 0 ? 0.0 : roomFrom(line, cell, side);
      const auto place = [&](double along_m) {
        return vertical ? Eigen::Vector2d(placeOf(line), along_m) : Eigen::Vector2d(along_m, placeOf(line));
      };
      if (side != 0 && side == side_before) {
        edges.back().to_m = place(end_m);
        edges.back().ink_m = std::min(edges.back().ink_m, ink_m);
        edges.back().paper_m = std::min(edges.back().paper_m, paper_m);
      } else if (side != 0) {
        const Eigen::Vector2d normal = vertical ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
        edges.push_back({place(begin_m), place(end_m), side * normal, ink_m, paper_m});
      }
      side_before = side;
    }
  }
}

std::vector<PrintedEdge> PrintedPattern::edges() const {
  std::vector<PrintedEdge> edges;
  addEdges(true, edges);
  addEdges(false, edges);
  return edges;
}

}  // namespace evical
