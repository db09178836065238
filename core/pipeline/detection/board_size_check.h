// Checks that the board is visible and matches the session. A board with a wrong number of rows or columns
// can be detected, too, and would give a wrong calibration.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/recording.h"
#include "core/frontend/detection_options.h"
#include "core/geometry/board.h"

#include <optional>
#include <span>
#include <string>

namespace evical {

// Counts of windows by outcome, as text.
std::string outcomes(const BoardObservations& observations);

// Throws CalibrationFailed if the board was never found. The reason has the camera's faults of the board,
// such as tags with other numbers.
void checkBoardSeen(const BoardObservations& observations, const Board& board,
                    std::span<const RecordingFault> faults);

// Throws CalibrationFailed if the views contradict the number of rows or columns.
void checkBoardSize(const BoardObservations& observations, const Board& board, const ExtentOptions& options);

// Warning about circles that were never seen in many views.
std::optional<RecordingFault> unseenCircles(const BoardObservations& observations, const Board& board);

const char* measurementsOf(CameraKind kind);  // "events", "frames", "points"

}  // namespace evical
