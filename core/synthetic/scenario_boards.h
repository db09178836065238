// The boards of a scenario: parsing, and each camera's view of them. A camera sees one board, with clutter
// behind it, and no other board.
#pragma once

#include "core/base/yaml_node.h"
#include "core/synthetic/scenario.h"

#include <cstddef>
#include <string>

namespace evical {

void readBoard(const YamlNode& map, Scenario& scenario);
void readFurtherBoards(const YamlNode& list, Scenario& scenario);

// Checks that need a scenario together with its bases. Throws CalibrationError (BadInput).
void validateBoards(const Scenario& scenario, const std::string& file);

const Board& boardOf(const Scenario& scenario, std::size_t camera);

// Empty if the camera sees the board whose frame is the world.
const SimulatedBoard* furtherBoardOf(const Scenario& scenario, std::size_t camera);

// The scene as if this camera's board were the only one, its frame the world: transform poses by
// boardFromWorld.
Scenario sceneOf(const Scenario& scenario, std::size_t camera);
RigidTransform boardFromWorld(const Scenario& scenario, std::size_t camera);

}  // namespace evical
