// What was found of the board as tables, with all digits: read back, they are the same observations.
#pragma once

#include "core/base/text_sink.h"
#include "core/data/board_observations.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// One line a point: where it was, how sure, how fast.
std::string detectionsCsv(const std::vector<BoardObservations>& cameras);
// Handed on view by view.
void detectionsCsv(const std::vector<BoardObservations>& cameras, const TextSink& sink);

// One line a window, frame or time: what became of it.
std::string windowsCsv(const std::vector<BoardObservations>& cameras);

// Views and windows from a folder's detections.csv and windows.csv, by camera; of a board with so many points.
// Throws CalibrationError (BadInput) for what is missing or damaged.
std::vector<BoardObservations> readDetections(const std::filesystem::path& folder, int points_of_board);

}  // namespace evical
