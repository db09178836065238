// SPDX-License-Identifier: GPL-3.0-or-later
// Data of each window in the list: outcome, fit to the calibration, speed of the board. Pure functions, for
// worker threads.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

#include <limits>
#include <optional>
#include <vector>

namespace evical::ui {

struct WindowRow {
  WindowReport report;
  WindowOutcome found = WindowOutcome::TooFewEvents;             // before a rejection by hand
  bool has_view = false;                                         // it can be rejected, or kept again
  double rms_px = std::numeric_limits<double>::quiet_NaN();      // of the circles used by the run
  double speed_px_s = std::numeric_limits<double>::quiet_NaN();  // median of the circles' speeds
};

// In time order, one per window.
std::vector<WindowRow> windowRows(const CalibrationRun& run, std::size_t camera);

// Nearest to the middle of all, among the windows with a complete board, or else any part of it.
std::optional<double> middleOfSeen_s(const std::vector<WindowReport>& windows);

}  // namespace evical::ui
