// Check of an old calibration with a new recording.
#pragma once

#include "core/data/assessment.h"

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

// Use of the windows of a recording without a board.
struct CheckedWindows {
  struct LeftOut {
    std::string key, words;
    std::size_t windows = 0;
  };
  std::string sensor;
  std::size_t all = 0, used = 0;
  std::size_t turning_alone = 0;  // used windows in which a translation does not improve the fit
  std::vector<LeftOut> left_out;  // by reason
};

struct CalibrationCheck : Assessment {
  bool without_board = false;           // if true, `windows` has the data used
  std::vector<CheckedWindows> windows;  // by event camera
};

}  // namespace evical
