// Numbers, order and rotation of a board's tags or markers, read from the edges of their bits. The bits of
// one tag are often too small for it, but the numbers on a board follow from each other.
#pragma once

#include "core/frontend/pattern_agreement.h"
#include "core/geometry/printed_pattern.h"

#include <optional>
#include <vector>

namespace evical {

struct TagReading {
  TagPrint print;
  int smallest = 0, largest = 0;  // numbers of the tags in view

  bool areOf(const Board& board) const {
    const int squares = board.rows * board.cols;
    const int tags = board.type == BoardType::AprilGrid ? squares : squares / 2;
    return smallest >= board.first_tag && largest < board.first_tag + tags;
  }
};

// Absent if no numbers agree clearly better with the crossings than others do. Of a ChArUco board, only
// numbers about those from 0 on are tried.
std::optional<TagReading> readTags(const std::vector<BoardCrossing>& crossings, const Board& board);

}  // namespace evical
