// The lattice of a board's corners among saddles, and its places on the board. Kinds of corners alternate
// along both lines, so a lattice is found in spite of many other saddles, such as those of a tag's bits.
#pragma once

#include "core/frontend/board_placement.h"
#include "core/frontend/board_scene.h"
#include "core/frontend/saddle_vote.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace evical {

struct CornerNode {
  int i = 0, j = 0;  // lines of corners, positively oriented in the image; of tags, even ones begin a tag
  std::size_t saddle = 0;
};

struct CornerLattice {
  std::vector<CornerNode> nodes;
  bool dark_ahead = false;  // between the lines of node (0, 0), towards +i +j, there is ink
};

// The lattice with the most corners; empty if there is none.
CornerLattice findCornerLattice(const std::vector<SaddleCandidate>& saddles,
                                const std::vector<MovedCrossing>& crossings, Resolution resolution_px,
                                const Board& board, const GridOptions& options);

// Motion of the image within a frame.
using FlowWithin = std::function<PlaneFlow(const ImageFrame&)>;

// Placements with nearly the largest number of corners on the board, in descending order.
std::vector<BoardPlacement> placeOnBoard(const CornerLattice& lattice,
                                         const std::vector<SaddleCandidate>& saddles, const FlowWithin& flow,
                                         const BoardScene& scene, std::int64_t time_ns,
                                         const GridOptions& options);

// The plane flow of the crossings within a frame, each of which measures it along its normal.
PlaneFlow flowOf(const std::vector<MovedCrossing>& crossings, const BoardScene& scene,
                 const ImageFrame& frame);

}  // namespace evical
