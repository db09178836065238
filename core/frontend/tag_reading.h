// Numbers, order and rotation of an AprilGrid's tags, read from the edges of their bits. The bits of one tag
// are often too small for it, but the numbers on a board follow from each other.
#pragma once

#include "core/frontend/pattern_agreement.h"
#include "core/geometry/printed_pattern.h"

#include <optional>
#include <vector>

namespace evical {

struct TagReading {
  TagPrint print;
  int smallest = 0, largest = 0;  // numbers of the tags in view
};

// Absent if no numbers agree clearly better with the crossings than others do.
std::optional<TagReading> readTags(const std::vector<BoardCrossing>& crossings, const Board& board);

}  // namespace evical
