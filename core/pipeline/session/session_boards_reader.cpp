#include "core/pipeline/session/session_boards_reader.h"

#include "core/base/error.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/given_points.h"
#include "core/pipeline/session/session_boards.h"
#include "core/pipeline/session/session_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace evical {
namespace {

// A length over many spacings instead of spacing_m; if both are given, they must agree.
std::optional<MeasuredLength> readMeasured(const YamlNode& board) {
  const auto map = board.find("measured");
  if (!map) return std::nullopt;
  map->allowOnly({"spacings", "length_m", "std_m"});
  constexpr int kMax = 200;
  constexpr double kLargest_m = 100.0;
  MeasuredLength measured;
  measured.spacings = (*map)["spacings"].integer(1, kMax);
  measured.length_m = (*map)["length_m"].real(1e-4, kLargest_m, "m");
  if (const auto node = map->find("std_m")) measured.std_m = node->real(0.0, kLargest_m, "m");
  if (const auto node = board.find("spacing_std"))
    throw node->error("is given twice: board.measured has a std_m", "Remove one of the two");
  constexpr double kSigmas = 3.0, kRounded = 1e-6;
  const auto spacing = board.find("spacing_m");
  if (!spacing) return measured;
  const double spacing_m = spacing->real(1e-4, 10.0, "m");
  if (std::abs(spacing_m / measured.spacing_m() - 1.0) > kSigmas * measured.relativeStd() + kRounded)
    throw spacing->error(
        fmt::format("{} m contradicts board.measured: {} m over {} spacings are {:.6g} m each", spacing_m,
                    measured.length_m, measured.spacings, measured.spacing_m()),
        "Correct one of them, or remove spacing_m; n circles in a row have n - 1 spacings");
  return measured;
}

// Runs a check and adds the board's key to its error: "board.radius_m".
template <class Check>
void checkedAt(const YamlNode& map, const Check& check) {
  try {
    check();
  } catch (const CalibrationError& problem) {
    const std::string key = problem.place().substr(problem.place().rfind('.') + 1);
    throw map.find(key).value_or(map).error(problem.problem(), problem.advice());
  }
}

// Spacing; for an AprilGrid also in Kalibr's form: the gap between two tags relative to the tag size.
double readSpacing_m(const YamlNode& map, const Board& board) {
  const auto share = map.find("tag_spacing"), spacing = map.find("spacing_m");
  if (share && spacing)
    throw share->error("duplicates spacing_m",
                       "Keep spacing_m (from one tag to the next) or tag_spacing (gap between two tags, "
                       "relative to tag_size_m)");
  if (board.type == BoardType::AprilGrid && !share && !spacing)
    throw map.error(
        "has neither spacing_m nor tag_spacing",
        "Add spacing_m (from one tag to the next), or tag_spacing (gap between two tags, relative to "
        "tag_size_m), as in Kalibr's target file");
  return share ? (1.0 + share->real(1e-3, 100.0, "")) * board.tag_size_m
               : map["spacing_m"].real(1e-4, 10.0, "m");
}

// Points in a file relative to the session, or in the session.
Board readPointsBoard(const YamlNode& map, const std::filesystem::path& folder) {
  map.allowOnly({"type", "points_m", "spacing_std"});
  const YamlNode node = map["points_m"];
  std::vector<Eigen::Vector2d> points_m =
      node.isSequence() ? pointsFrom(node) : loadPoints(besideSession(node, folder));
  if (points_m.empty()) throw node.error("has no points", "Give at least four points, preferably dozens");
  Board board = boardOfPoints(std::move(points_m));
  checkedAt(map, [&] { validate(board); });
  return board;
}

// Refuses the keys of Kalibr's targets.
void refuseKalibrKeys(const YamlNode& map) {
  for (const char* const key :
       {"target_type", "targetRows", "targetCols", "tagRows", "tagCols", "tagSize", "tagSpacing",
        "rowSpacingMeters", "colSpacingMeters", "spacingMeters", "asymmetricGrid"})
    if (const auto node = map.find(key))
      throw node->error(
          "is a key of Kalibr's target files",
          "Import that file, or describe the board with type, rows, cols, spacing_m, and radius_m or "
          "tag_size_m");
}

Board readBoard(const YamlNode& map, const std::optional<MeasuredLength>& measured,
                const std::filesystem::path& folder) {
  constexpr int kMaxTag = 586;  // of the family tag36h11
  refuseKalibrKeys(map);
  Board board;
  board.type = static_cast<BoardType>(map["type"].choice(kBoardTypeNames));
  if (!board.hasPattern()) return readPointsBoard(map, folder);
  std::vector<std::string> keys = {"type",      "rows",        "cols",    "measured",
                                   "spacing_m", "spacing_std", "blinking"};
  if (board.hasCircles()) keys.insert(keys.end(), {"radius_m", "circles"});
  if (board.hasTags()) keys.emplace_back("tag_size_m");
  if (board.type == BoardType::AprilGrid) keys.insert(keys.end(), {"tag_spacing", "first_tag"});
  map.allowOnly(keys);
  board.rows = map["rows"].integer(1, 100);
  board.cols = map["cols"].integer(1, 100);
  if (board.hasTags()) board.tag_size_m = map["tag_size_m"].real(1e-4, 10.0, "m");
  if (const auto node = map.find("first_tag")) board.first_tag = node->integer(0, kMaxTag);
  board.spacing_m = measured ? measured->spacing_m() : readSpacing_m(map, board);
  board.radius_m = board.hasCircles() ? map["radius_m"].real(1e-5, 10.0, "m") : 0.0;
  if (const auto node = map.find("circles"))
    board.circles = static_cast<CircleShade>(node->choice({"dark", "bright"}));
  checkedAt(map, [&] { validate(board); });
  if (measured) checkedAt(map["measured"], [&] { validate(*measured, board); });
  return board;
}

// Relative sigma of the board's spacing; 0: exact.
void readSpacingStd(const YamlNode& board, CalibrationOptions& options) {
  const auto node = board.find("spacing_std");
  if (!node) return;
  options.optimisation.edit().free_board_size = node->real(0.0, 1.0, "") > 0.0;
  if (options.optimisation->free_board_size)
    setFromSession(*node, options, "optimisation.board_spacing_sigma");
}

void readFirstBoard(const YamlNode& map, const std::filesystem::path& folder, Session& session) {
  const std::optional<MeasuredLength> measured = readMeasured(map);
  session.board = readBoard(map, measured, folder);
  if (const auto node = map.find("blinking")) session.board_blinks = node->choice({"false", "true"}) == 1;
  setMeasuredLength(measured, session);
  readSpacingStd(map, session.options);
}

SessionBoard readFurtherBoard(const YamlNode& map, const std::string& board_name,
                              const std::filesystem::path& folder) {
  if (const auto node = map.find("blinking"))
    throw node->error("a blinking board cannot be combined with others", "Remove it, or the other boards");
  const std::optional<MeasuredLength> measured = readMeasured(map);
  SessionBoard further{{board_name, readBoard(map, measured, folder), spacingStd(measured)}, measured};
  if (const auto node = map.find("spacing_std"))
    further.spacing_std = std::max(kExactSpacing, node->real(0.0, 1.0, ""));
  return further;
}

}  // namespace

// One board, or several by name; the first is that of the reference, which defines the world.
void readBoards(const YamlNode& root, const std::filesystem::path& folder, Session& session) {
  const auto several = root.find("boards");
  if (!several) {
    const char* const advice =
        "Give the board's type, rows, cols and dimensions. If a proposed session has them as comments, "
        "correct "
        "them and remove the '#' in front of each line";
    const auto board = root.find("board");
    if (!board) throw badInput(root.place() + ": board", "is missing", advice);
    if (board->isNull()) throw board->error("is empty", advice);
    return readFirstBoard(*board, folder, session);
  }
  if (root.has("board"))
    throw several->error("is given in addition to board", "Keep one of the two: boards lists them by name");
  const std::vector<std::string> names = several->keys();
  if (names.empty()) throw several->error("is empty", "Describe at least one board");
  const std::string& seen = session.cameras[session.worldCamera()].board;
  const bool known = std::find(names.begin(), names.end(), seen) != names.end();
  session.board_name = known ? seen : names.front();
  readFirstBoard((*several)[session.board_name], folder, session);
  for (const std::string& each : names)
    if (each != session.board_name)
      session.further_boards.push_back(readFurtherBoard((*several)[each], each, folder));
}

}  // namespace evical
