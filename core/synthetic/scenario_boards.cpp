#include "core/synthetic/scenario_boards.h"

#include "core/base/error.h"
#include "core/synthetic/scenario_fields.h"

#include <algorithm>
#include <set>

namespace evical {
namespace {

constexpr double kLargestBow_m = 0.1;

void readMeasures(const YamlNode& map, Board& board) {
  if (const auto node = map.find("type")) board.type = static_cast<BoardType>(node->choice(kPatternNames));
  get(map, "circles", board.circles, {"dark", "bright"});
  get(map, "rows", board.rows, 1, 100);
  get(map, "cols", board.cols, 1, 100);
  get(map, "spacing_m", board.spacing_m, 1e-4, 10.0, "m");
  get(map, "radius_m", board.radius_m, 1e-5, 10.0, "m");
  get(map, "tag_size_m", board.tag_size_m, 1e-4, 10.0, "m");
  if (!board.hasCircles()) board.radius_m = 0.0;
}

void validateBoard(const Board& board, const std::string& place) {
  try {
    validate(board);
  } catch (const CalibrationError& error) {
    throw badInput(place + error.place(), error.problem(), error.advice());
  }
}

}  // namespace

void readBoard(const YamlNode& map, Scenario& scenario) {
  map.allowOnly({"type", "circles", "rows", "cols", "spacing_m", "radius_m", "stretch", "row_bow_m",
                 "column_bow_m", "twist_m", "tag_size_m", "tag_rotation_deg", "tag_border_bits", "markers"});
  readMeasures(map, scenario.board);
  if (const auto turned = map.find("tag_rotation_deg"))
    scenario.tag_print.quarter_turns = static_cast<int>(turned->choice({"0", "90", "180", "270"}));
  get(map, "tag_border_bits", scenario.tag_print.border_bits, 1, 2);
  get(map, "markers", scenario.tag_print.markers);
  get(map, "stretch", scenario.board_stretch, -0.1, 0.1, "");
  get(map, "row_bow_m", scenario.board_bow.rows_m, -kLargestBow_m, kLargestBow_m, "m");
  get(map, "column_bow_m", scenario.board_bow.columns_m, -kLargestBow_m, kLargestBow_m, "m");
  get(map, "twist_m", scenario.board_bow.twist_m, -kLargestBow_m, kLargestBow_m, "m");
}

void readFurtherBoards(const YamlNode& list, Scenario& scenario) {
  scenario.further_boards.clear();
  for (const YamlNode& map : list.items()) {
    map.allowOnly({"name", "world_from_board", "type", "circles", "rows", "cols", "spacing_m", "radius_m",
                   "tag_size_m"});
    SimulatedBoard& further = scenario.further_boards.emplace_back();
    get(map, "name", further.name);
    readMeasures(map, further.board);
    if (const auto node = map.find("world_from_board")) readTransform(*node, further.world_from_board);
  }
}

void validateBoards(const Scenario& scenario, const std::string& file) {
  validateBoard(scenario.board, file + ": ");
  std::set<std::string> names = {SimulatedBoard().name};
  for (const SimulatedBoard& further : scenario.further_boards) {
    if (!names.insert(further.name).second)
      throw badInput(file + ": further_boards", fmt::format("two boards have the name {}", further.name),
                     "Give each board a unique name");
    validateBoard(further.board, fmt::format("{}: further_boards {}: ", file, further.name));
  }
  for (const SimulatedCamera& camera : scenario.cameras)
    if (!names.contains(camera.board))
      throw badInput(fmt::format("{}: board of {}", file, camera.name),
                     fmt::format("there is no board with the name '{}'", camera.board),
                     "Name one of further_boards");
}

const SimulatedBoard* furtherBoardOf(const Scenario& scenario, std::size_t camera) {
  for (const SimulatedBoard& further : scenario.further_boards)
    if (further.name == scenario.cameras[camera].board) return &further;
  return nullptr;
}

const Board& boardOf(const Scenario& scenario, std::size_t camera) {
  const SimulatedBoard* const further = furtherBoardOf(scenario, camera);
  return further ? further->board : scenario.board;
}

Scenario sceneOf(const Scenario& scenario, std::size_t camera) {
  Scenario scene = scenario;
  const SimulatedBoard* const further = furtherBoardOf(scenario, camera);
  if (!further) return scene;
  scene.board = further->board;
  scene.tag_print = {};
  scene.board_stretch = 0.0;
  scene.board_bow = {};
  scene.scene.hand = {};
  scene.scene.people = {};
  return scene;
}

RigidTransform boardFromWorld(const Scenario& scenario, std::size_t camera) {
  const SimulatedBoard* const further = furtherBoardOf(scenario, camera);
  return further ? inverse(further->world_from_board) : RigidTransform{};
}

}  // namespace evical
