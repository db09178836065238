#include "core/report/board_squares.h"

#include "core/base/error.h"
#include "core/geometry/charuco_layout.h"
#include "core/geometry/tag_bits.h"

#include <fmt/format.h>
#include <opencv2/aruco.hpp>

#include <algorithm>
#include <array>

namespace evical {
namespace {

using Boxes = std::vector<PaintedBox>;
// Of a square of bits, row by row from the top left, without border.
using Bits = std::vector<std::vector<bool>>;

void paintSquare(const Eigen::Vector2d& corner_m, double size_m, Boxes& boxes) {
  boxes.push_back({corner_m, Eigen::Vector2d::Constant(size_m), false});
}

// A dark square with a border, and on it its bright bits, neighbours in a row as one.
void paintTag(const Eigen::Vector2d& corner_m, double size_m, int border_bits, const Bits& bits,
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

Bits bitsOf(const TagBits& tag) {
  Bits bits;
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
    throw badInput("board", fmt::format("needs {} tags, and tag36h11 has {}", needed, tags.size()),
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

Bits markerBits(const cv::aruco::Dictionary& dictionary, int id) {
  const int size = dictionary.markerSize;
  cv::Mat picture;
  dictionary.drawMarker(id, size + 2, picture);
  Bits bits;
  for (int y = 0; y < size; ++y) {
    bits.emplace_back();
    for (int x = 0; x < size; ++x) bits.back().push_back(picture.at<std::uint8_t>(y + 1, x + 1) > 127);
  }
  return bits;
}

// The largest set of a family: its smaller ones are the beginnings of it.
cv::Ptr<cv::aruco::Dictionary> dictionaryOf(const std::string& markers) {
  constexpr std::array kSets = {cv::aruco::DICT_4X4_1000, cv::aruco::DICT_5X5_1000, cv::aruco::DICT_6X6_1000,
                                cv::aruco::DICT_7X7_1000, cv::aruco::DICT_ARUCO_ORIGINAL};
  const std::vector<std::string>& names = markerNames();
  const auto found = std::find(names.begin(), names.end(), markers);
  if (found == names.end())
    throw badInput("markers", "'" + markers + "' is no dictionary", "Use 4x4, 5x5, 6x6, 7x7 or original");
  return cv::aruco::getPredefinedDictionary(kSets.at(static_cast<std::size_t>(found - names.begin())));
}

Boxes charuco(const Board& board, const std::string& markers) {
  const cv::Ptr<cv::aruco::Dictionary> dictionary = dictionaryOf(markers);
  const std::vector<BoardSquare> bright = charucoMarkers(board, false);
  if (static_cast<int>(bright.size()) > dictionary->bytesList.rows)
    throw badInput(
        "board",
        fmt::format("needs {} markers, and the dictionary has {}", bright.size(), dictionary->bytesList.rows),
        "Use fewer rows or columns");
  Boxes boxes;
  for (const BoardSquare& dark : charucoMarkers(board, true))
    paintSquare(squareCorner_m(board, dark), board.spacing_m, boxes);
  const double margin_m = 0.5 * (board.spacing_m - board.tag_size_m);
  for (std::size_t id = 0; id < bright.size(); ++id)
    paintTag(squareCorner_m(board, bright[id]) + Eigen::Vector2d::Constant(margin_m), board.tag_size_m, 1,
             markerBits(*dictionary, static_cast<int>(id)), boxes);
  return boxes;
}

}  // namespace

const std::vector<std::string>& markerNames() {
  static const std::vector<std::string> names = {"4x4", "5x5", "6x6", "7x7", "original"};
  return names;
}

std::vector<PaintedBox> boardSquares(const Board& board, const TagPrint& print) {
  switch (board.type) {
    case BoardType::Checkerboard:
      return checkerboard(board);
    case BoardType::AprilGrid:
      return tagGrid(board, print.border_bits);
    case BoardType::Charuco:
      return charuco(board, print.markers);
    default:
      return {};
  }
}

}  // namespace evical
