// Is there a board, and is it the one of the session? A wrong number of rows or columns is found all the
// same, and may calibrate to something wrong.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/recording.h"
#include "core/frontend/detection_options.h"
#include "core/geometry/board.h"

#include <optional>
#include <string>

namespace evical {

// How many windows ended how, in words.
std::string outcomes(const BoardObservations& observations);

// Throws CalibrationFailed where the board was never found.
void checkBoardSeen(const BoardObservations& observations, const Board& board);

// Throws CalibrationFailed where the views contradict the number of rows or columns.
void checkBoardSize(const BoardObservations& observations, const Board& board, const ExtentOptions& options);

// Circles that were never seen, though many views were: worth a warning.
std::optional<RecordingFault> unseenCircles(const BoardObservations& observations, const Board& board);

const char* measurementsOf(CameraKind kind);  // "events", "frames", "points"

}  // namespace evical
