#include "core/geometry/tag_layout.h"

#include "core/geometry/homography.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>

namespace evical {
namespace {

Eigen::Vector2d middleOf(const TagCorners& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

// Indices of the nearest other tags in the picture.
std::vector<std::size_t> nearestTags(std::size_t tag, const std::vector<Eigen::Vector2d>& middles_px) {
  constexpr std::size_t kMax = 8;  // fewer would be in one row if the board is seen from the side
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < middles_px.size(); ++k)
    if (k != tag) others.push_back(k);
  const std::size_t count = std::min(kMax, others.size());
  std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), others.end(),
                    [&](std::size_t a, std::size_t b) {
                      return (middles_px[a] - middles_px[tag]).squaredNorm() <
                             (middles_px[b] - middles_px[tag]).squaredNorm();
                    });
  others.resize(count);
  return others;
}

double meanDistance(const Eigen::Matrix3d& picture_from_board, const TagCorners& place_m,
                    const TagCorners& corners_px) {
  double sum = 0.0;
  for (std::size_t k = 0; k < place_m.size(); ++k)
    sum += ((picture_from_board * place_m[k].homogeneous()).hnormalized() - corners_px[k]).norm();
  return sum / kTagCornerCount;
}

// "rotated by 90 deg clockwise within their squares"; empty for 0.
std::string rotationText(int quarter_turns_counterclockwise) {
  constexpr std::array kTurns = {"", "90 deg counterclockwise", "180 deg", "90 deg clockwise"};
  if (quarter_turns_counterclockwise == 0) return {};
  return std::string("rotated by ") + kTurns.at(static_cast<std::size_t>(quarter_turns_counterclockwise)) +
         " within their squares";
}

}  // namespace

std::vector<TagLayout> distinctLayouts(const Board& board) {
  std::vector<TagOrder> orders = {TagOrder::RowsUp};
  if (board.rows > 1 && board.cols > 1) orders.push_back(TagOrder::RowsDown);
  // On a square board, columns are the rows of the board after a quarter turn.
  if (orders.size() > 1 && board.rows != board.cols)
    orders.insert(orders.end(), {TagOrder::ColumnsUp, TagOrder::ColumnsDown});
  const int turns = board.rows * board.cols > 1 ? kTagCornerCount : 1;
  std::vector<TagLayout> layouts;
  for (const TagOrder order : orders)
    for (int turn = 0; turn < turns; ++turn) layouts.push_back({order, turn});
  return layouts;
}

int squareOf(const Board& board, TagOrder order, int tag) {
  const bool by_rows = order == TagOrder::RowsUp || order == TagOrder::RowsDown;
  const int col = by_rows ? tag % board.cols : tag / board.rows;
  const int row = by_rows ? tag / board.cols : tag % board.rows;
  const bool up = order == TagOrder::RowsUp || order == TagOrder::ColumnsUp;
  return (up ? row : board.rows - 1 - row) * board.cols + col;
}

TagCorners rotatedCorners(const TagCorners& square, int quarter_turns) {
  TagCorners corners = square;
  std::rotate(corners.begin(), corners.begin() + quarter_turns, corners.end());
  return corners;
}

double agreementOfNeighbours(const std::vector<SeenTag>& tags, const std::vector<TagCorners>& places_m,
                             double largest_error) {
  std::vector<Eigen::Vector2d> middles_px;
  for (const SeenTag& tag : tags) middles_px.push_back(middleOf(tag.corners_px));
  int pairs = 0, agreeing = 0;
  for (std::size_t k = 0; k < tags.size(); ++k) {
    const auto picture_from_board = fitHomography({places_m[k].begin(), places_m[k].end()},
                                                  {tags[k].corners_px.begin(), tags[k].corners_px.end()});
    if (!picture_from_board) continue;
    for (const std::size_t other : nearestTags(k, middles_px)) {
      const double distance_px = (middles_px[other] - middles_px[k]).norm();
      ++pairs;
      if (meanDistance(*picture_from_board, places_m[other], tags[other].corners_px) <
          largest_error * distance_px)
        ++agreeing;
    }
  }
  return pairs > 0 ? static_cast<double>(agreeing) / pairs : 1.0;
}

std::string layoutRemark(const TagLayout& layout) {
  constexpr std::array kOrders = {"", "row by row from the top left", "column by column from the bottom left",
                                  "column by column from the top left"};
  if (layout == TagLayout{}) return {};
  std::string text = rotationText(layout.quarter_turns);
  if (layout.order != TagOrder::RowsUp) {
    if (!text.empty()) text += " and ";
    text += std::string("numbered ") + kOrders.at(static_cast<std::size_t>(layout.order));
  }
  return "compared with Kalibr's boards, the tags are " + text + "; this is accounted for";
}

std::string markerRemark(int quarter_turns_counterclockwise) {
  const std::string text = rotationText(quarter_turns_counterclockwise % kTagCornerCount);
  return text.empty() ? text
                      : "compared with OpenCV's boards, the markers are " + text + "; this is accounted for";
}

std::string otherTagsText(const Board& board, int smallest, int largest) {
  const int tags = board.rows * board.cols, first = board.first_tag, end = first + tags;
  if (largest < end && smallest >= first) return {};
  if (smallest != first && (smallest >= end || largest < first || largest - smallest + 1 == tags))
    return fmt::format(
        "tags {} to {} were detected, but a board of {} x {} tags from {} on has tags up to {}: this is "
        "another board, or first_tag should be {}",
        smallest, largest, board.rows, board.cols, first, end - 1, smallest);
  return fmt::format(
      "tag {} was detected, but a board of {} x {} tags has tags {} to {}: check rows and columns",
      largest >= end ? largest : smallest, board.rows, board.cols, first, end - 1);
}

}  // namespace evical
