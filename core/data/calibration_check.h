// Check of an old calibration with a new recording.
#pragma once

#include "core/data/assessment.h"

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

// What became of the windows of a recording without a board.
struct CheckedWindows {
  struct LeftOut {
    std::string key, words;
    std::size_t windows = 0;
  };
  std::string sensor;
  std::size_t all = 0, used = 0;
  std::size_t turning_alone = 0;  // used ones in which translation explains no more
  std::vector<LeftOut> left_out;  // for each reason
};

struct CalibrationCheck : Assessment {
  bool without_board = false;           // then `windows` says what it rests on
  std::vector<CheckedWindows> windows;  // by event camera
};

}  // namespace evical
