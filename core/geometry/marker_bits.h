// The markers of ChArUco boards: ArUco's dictionaries.
#pragma once

#include <string>
#include <vector>

namespace evical {

// Bright bits of a square, row by row from the top left, without the border.
using PatternBits = std::vector<std::vector<bool>>;

inline constexpr const char* kUsualMarkers = "5x5";
const std::vector<std::string>& markerNames();  // of dictionaries

// The first `count` markers by number. Throws CalibrationError (BadInput) if the dictionary does not exist,
// or has fewer.
std::vector<PatternBits> firstMarkers(const std::string& dictionary, int count);

}  // namespace evical
