// Detections of the board as tables, with all digits: reading them back gives identical observations.
#pragma once

#include "core/base/atomic_file.h"
#include "core/data/board_observations.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// One line for each point: position, covariance, velocity.
std::string detectionsCsv(const std::vector<BoardObservations>& cameras);
// The same, passed on view by view.
void detectionsCsv(const std::vector<BoardObservations>& cameras, const TextSink& sink);

// One line for each window, frame or time, with its outcome.
std::string windowsCsv(const std::vector<BoardObservations>& cameras);

// Views and windows from a folder's detections.csv and windows.csv, by camera, for a board with
// `points_of_board` points. Throws CalibrationError (BadInput) if data are missing or damaged.
std::vector<BoardObservations> readDetections(const std::filesystem::path& folder, int points_of_board);

}  // namespace evical
