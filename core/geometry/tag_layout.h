// Places of tags on a board: which square has which tag, and the tag's rotation within its square. Programs
// that draw boards differ in both; the relative places of detected tags show them.
#pragma once

#include "core/geometry/board.h"

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace evical {

inline constexpr int kTagCornerCount = 4;
using TagCorners = std::array<Eigen::Vector2d, kTagCornerCount>;

struct SeenTag {
  int id = 0;
  TagCorners corners_px;  // in the order of the upright tag's corners

  double side_px() const { return (corners_px[1] - corners_px[0]).norm(); }
};

// Order of numbers on an AprilGrid. Other corners to start from are half turns of the board.
enum class TagOrder { RowsUp, RowsDown, ColumnsUp, ColumnsDown };  // Kalibr's, OpenCV's, ...

struct TagLayout {
  TagOrder order = TagOrder::RowsUp;
  int quarter_turns = 0;  // of each tag within its square, counterclockwise

  bool operator==(const TagLayout&) const = default;
};

// The layouts of an AprilGrid that differ by more than a rotation of the whole board; Kalibr's is the first.
std::vector<TagLayout> distinctLayouts(const Board& board);

// Kalibr's number of the square with this tag: its points are 4 n to 4 n + 3 (Board::point_m).
int squareOf(const Board& board, TagOrder order, int tag);

// Corners of a square in the order of the corners of a tag that is rotated within it.
TagCorners rotatedCorners(const TagCorners& square, int quarter_turns);

// Share of pairs of neighbouring tags whose image agrees with their places on the board, which are given in
// the order of the tags, up to an error relative to the distance. Lens distortion hardly affects it. 1 for a
// single tag.
double agreementOfNeighbours(const std::vector<SeenTag>& tags, const std::vector<TagCorners>& places_m,
                             double largest_error);

// The difference from Kalibr's layout, as a remark on the tags; empty if there is none.
std::string layoutRemark(const TagLayout& layout);
// The same for markers of ChArUco boards and OpenCV's.
std::string markerRemark(int quarter_turns_counterclockwise);

// Why tags with these numbers are not, or not all, of the board; empty if they are.
std::string otherTagsText(const Board& board, int smallest, int largest);

}  // namespace evical
