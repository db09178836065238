// The markers of ChArUco boards: ArUco's dictionaries.
#pragma once

#include "core/geometry/board.h"

#include <string>
#include <vector>

namespace evical {

// Bright bits of a square, row by row from the top left, without the border.
using PatternBits = std::vector<std::vector<bool>>;
PatternBits turned(PatternBits bits, int quarter_turns);  // clockwise

inline constexpr const char* kUsualMarkers = "5x5";
const std::vector<std::string>& markerNames();  // of dictionaries

int markerCount(const std::string& dictionary);

// The first `count` markers by number. Throws CalibrationError (BadInput) if the dictionary does not exist,
// or has fewer.
std::vector<PatternBits> firstMarkers(const std::string& dictionary, int count);

// Places of a ChArUco board's markers: in its bright squares, numbered row by row from the top left.
struct BoardSquare {
  int row = 0, col = 0;
};

// By number. The top left square is dark, unless `first_is_bright`: OpenCV before 4.6 drew boards with an
// even number of rows in this way, which it calls legacy.
std::vector<BoardSquare> charucoMarkers(const Board& board, bool first_is_bright);

// Top left corner of a square, in the board's frame, whose origin is the first inner corner.
Eigen::Vector2d squareCorner_m(const Board& board, const BoardSquare& square);

// The tags of AprilGrids: the family 36h11.

inline constexpr int kTagSide_bits = 6;  // without the border
inline constexpr int kTagFamilySize = 587;

// The first `count` tags by number; at most those of the family.
std::vector<PatternBits> firstTags(int count);

}  // namespace evical
