// SPDX-License-Identifier: GPL-3.0-or-later
// What the list of windows says of each: how it came out, how well it fits the calibration, how fast the board moved.
// Pure functions, for worker threads.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

#include <limits>
#include <optional>
#include <vector>

namespace evical::ui {

struct WindowRow {
  WindowReport report;
  WindowOutcome found = WindowOutcome::TooFewEvents;             // before a person rejected it
  bool has_view = false;                                         // it can be rejected, or kept again
  double rms_px = std::numeric_limits<double>::quiet_NaN();      // of the circles that the run used
  double speed_px_s = std::numeric_limits<double>::quiet_NaN();  // median of the circles'
};

// In time order, one a window.
std::vector<WindowRow> windowRows(const CalibrationRun& run, std::size_t camera);

// Of the windows in which the whole board was found, else any of it, the one that is nearest to the middle of all.
std::optional<double> middleOfSeen_s(const std::vector<WindowReport>& windows);

}  // namespace evical::ui
