#include "core/pipeline/session/session_boards.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/yaml_node.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/given_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {
namespace {

// With several boards, each camera sees one, each is seen, and the first defines the world.
void checkSeen(const Session& session, const std::string& place) {
  const std::vector<std::string> names = boardNames(session);
  std::vector<bool> seen(names.size());
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const std::string& name = session.cameras[k].board;
    const std::string key = fmt::format("{}: cameras.{}.board", place, session.cameras[k].name);
    if (name.empty() && names.size() > 1)
      throw badInput(key, "is missing, but there are several boards", "Name the board that this camera sees");
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
      throw badInput(key, fmt::format("there is no board '{}'", name), nameAdvice(name, names));
    seen[session.boardIndexOf(k)] = true;
  }
  // Names of boards and sensors must differ: both are prefixes of quantity names.
  for (const std::string& name : hasNamedBoards(session) ? names : std::vector<std::string>())
    if (isSensorName(session, name))
      throw badInput(fmt::format("{}: boards.{}", place, name), "is also a sensor's name",
                     "Rename one of them");
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!seen[i])
      throw badInput(fmt::format("{}: boards.{}", place, names[i]), "no camera sees it",
                     "Remove it, or add to the camera that sees it: board: " + names[i]);
  if (session.boardIndexOf(session.worldCamera()) != 0)
    throw badInput(place + ": boards",
                   fmt::format("the first board defines the world, so '{}' must see it",
                               session.cameras[session.worldCamera()].name),
                   "List the board that it sees first");
  if (names.size() > 1 && session.board_blinks)
    throw badInput(place + ": boards", "a blinking board cannot be combined with others",
                   "Calibrate each camera's intrinsics with a separate session");
}

void checkTurned(const Session& session, const Board& board, const std::string& key) {
  if (session.imus.empty() || session.board_blinks || !board.hasHalfTurnAmbiguity()) return;
  const BoardType type = board.type;
  throw badInput(
      key + (type == BoardType::SymmetricCircles ? ".type" : ".rows"),
      fmt::format("{} looks the same when turned by 180 degrees, so the camera's pose is ambiguous and an "
                  "IMU cannot be calibrated with it",
                  type == BoardType::SymmetricCircles ? "a symmetric board"
                  : type == BoardType::Checkerboard
                      ? "a checkerboard whose rows and columns of inner corners are both even or both odd"
                      : "an asymmetric board with an even number of rows"),
      type == BoardType::Checkerboard
          ? "Use a board with one even and one odd number, or remove the IMUs to calibrate only intrinsics"
          : (type == BoardType::AsymmetricCircles && board.cols % 2 == 1
                 ? fmt::format("Are rows and cols exchanged ({} and {})? If not: use", board.cols, board.rows)
                 : std::string("Use")) +
                " an asymmetric board with an odd number of rows, or remove the IMUs to calibrate only "
                "intrinsics");
}

// True if the measured length still matches the spacing: either may have been changed since.
bool tellsSpacing(const std::optional<MeasuredLength>& measured, const Board& board) {
  return measured && measured->spacing_m() == board.spacing_m;
}
bool tellsSigma(const std::optional<MeasuredLength>& measured, const OptimisationOptions& options) {
  if (!measured) return false;
  return measured->std_m > 0.0
             ? options.board_spacing_sigma == measured->relativeStd() && options.free_board_size
             : !options.free_board_size;
}

void forgetSigma(OptimisationOptions& options) {
  const OptimisationOptions defaults;
  options.board_spacing_sigma = defaults.board_spacing_sigma;
  options.free_board_size = defaults.free_board_size;
}

// Keys of a board, one per line.
std::vector<std::string> boardLines(const Board& board, const std::optional<MeasuredLength>& measured) {
  if (!board.hasPattern())
    return {fmt::format("type: {}", boardTypeName(board.type)),
            fmt::format("points_m: {}", pointsYaml(board))};
  std::vector<std::string> lines = {fmt::format("type: {}", boardTypeName(board.type)),
                                    fmt::format("rows: {}", board.rows), fmt::format("cols: {}", board.cols),
                                    tellsSpacing(measured, board)
                                        ? fmt::format("measured: {{spacings: {}, length_m: {}, std_m: {}}}",
                                                      measured->spacings, measured->length_m, measured->std_m)
                                        : fmt::format("spacing_m: {}", board.spacing_m)};
  if (board.hasCircles()) {
    lines.push_back(fmt::format("radius_m: {}", board.radius_m));
    lines.push_back(fmt::format("circles: {}", board.circles == CircleShade::Dark ? "dark" : "bright"));
  }
  if (board.tag_size_m > 0.0) lines.push_back(fmt::format("tag_size_m: {}", board.tag_size_m));
  if (board.first_tag != 0) lines.push_back(fmt::format("first_tag: {}", board.first_tag));
  return lines;
}

std::string indented(const std::vector<std::string>& lines, std::size_t indent) {
  std::string text;
  for (const std::string& line : lines) text += std::string(indent, ' ') + line + "\n";
  return text;
}

// Relative sigma of the world board's spacing, in the form of a further board.
double worldsSpacingStd(const OptimisationOptions& options) {
  return options.free_board_size ? options.board_spacing_sigma : kExactSpacing;
}

// Boards with the world board's sigma keep it when the option changes for a new world board.
void setWorldsSpacingStd(double spacing_std, Session& session) {
  OptimisationOptions& options = session.options.optimisation.edit();
  const double before = worldsSpacingStd(options);
  if (spacing_std == before) return;
  for (SessionBoard& further : session.further_boards)
    further.spacing_std = further.spacing_std.value_or(before);
  forgetSigma(options);
  options.free_board_size = spacing_std > kExactSpacing;
  if (options.free_board_size) options.board_spacing_sigma = spacing_std;
}

// Makes a board the world's; the old one becomes the first of the further boards.
void makeWorlds(std::size_t index, Session& session) {
  const auto place = session.further_boards.begin() + static_cast<std::ptrdiff_t>(index) - 1;
  SessionBoard world = std::move(*place);
  session.further_boards.erase(place);
  SessionBoard before{{session.board_name, session.board}, session.measured};
  if (before.measured) before.spacing_std = worldsSpacingStd(*session.options.optimisation);
  session.further_boards.insert(session.further_boards.begin(), std::move(before));
  if (world.spacing_std) setWorldsSpacingStd(*world.spacing_std, session);
  session.board_name = world.name;
  session.board = world.board;
  session.measured = world.measured;
}

// "tags" and "tags_2" give "tags_2" or "tags_3".
std::string freeName(const std::string& like, const Session& session) {
  const std::vector<std::string> names = boardNames(session);
  const std::size_t digits = like.find_last_not_of("0123456789") + 1;
  const bool numbered = digits < like.size() && digits > 1 && like[digits - 1] == '_';
  const std::string base = numbered ? like.substr(0, digits - 1) : like;
  std::string name;
  for (int i = 2;; ++i) {
    name = fmt::format("{}_{}", base, i);
    if (std::find(names.begin(), names.end(), name) == names.end() && !isSensorName(session, name))
      return name;
  }
}

}  // namespace

std::vector<std::string> boardNames(const Session& session) {
  std::vector<std::string> names = {session.board_name};
  for (const AdditionalBoard& further : session.further_boards) names.push_back(further.name);
  return names;
}

const Board& boardAt(const Session& session, std::size_t index) {
  return index == 0 ? session.board : session.further_boards.at(index - 1).board;
}

const std::optional<MeasuredLength>& measuredAt(const Session& session, std::size_t index) {
  return index == 0 ? session.measured : session.further_boards.at(index - 1).measured;
}

bool hasNamedBoards(const Session& session) {
  return !session.further_boards.empty() || session.board_name != Session().board_name;
}

std::string boardKey(const Session& session, std::size_t index) {
  return hasNamedBoards(session) ? "boards." + boardNames(session).at(index) : "board";
}

std::optional<double> spacingStd(const std::optional<MeasuredLength>& measured) {
  if (!measured) return std::nullopt;
  return std::max(kExactSpacing, measured->relativeStd());
}

void setBoardAt(std::size_t index, const Board& board, Session& session) {
  (index == 0 ? session.board : session.further_boards.at(index - 1).board) = board;
}

void setMeasuredLength(const std::optional<MeasuredLength>& measured, Session& session) {
  if (tellsSigma(session.measured, *session.options.optimisation))
    forgetSigma(session.options.optimisation.edit());
  session.measured = measured;
  if (!measured) return;
  session.board.spacing_m = measured->spacing_m();
  OptimisationOptions& options = session.options.optimisation.edit();
  options.free_board_size = measured->std_m > 0.0;
  if (options.free_board_size) options.board_spacing_sigma = measured->relativeStd();
}

void setMeasuredAt(std::size_t index, const std::optional<MeasuredLength>& measured, Session& session) {
  if (index == 0) return setMeasuredLength(measured, session);
  SessionBoard& further = session.further_boards.at(index - 1);
  further.measured = measured;
  further.spacing_std = spacingStd(measured);
  if (measured) further.board.spacing_m = measured->spacing_m();
}

void addBoard(std::size_t like, Session& session) {
  SessionBoard added = like > 0 ? session.further_boards.at(like - 1)
                                : SessionBoard{{session.board_name, session.board}, session.measured};
  if (like == 0) added.spacing_std = spacingStd(added.measured);
  added.name = freeName(added.name, session);
  session.further_boards.push_back(std::move(added));
  settleBoards(session);
}

void removeBoard(std::size_t index, Session& session) {
  const std::string name = boardNames(session).at(index);
  if (index == 0) makeWorlds(1, session);
  std::erase_if(session.further_boards, [&](const AdditionalBoard& further) { return further.name == name; });
  for (SessionCamera& camera : session.cameras)
    if (camera.board == name) camera.board = session.board_name;
  settleBoards(session);
}

void renameBoard(std::size_t index, const std::string& name, Session& session) {
  const std::vector<std::string> names = boardNames(session);
  const std::string& before = names.at(index);
  if (name == before) return;
  if (name.empty()) throw badInput(boardKey(session, index), "the name is empty", "Give the board a name");
  if (std::find(names.begin(), names.end(), name) != names.end())
    throw badInput(boardKey(session, index), fmt::format("'{}' is another board's name", name),
                   "Choose a different name");
  if (isSensorName(session, name))
    throw badInput(boardKey(session, index), fmt::format("'{}' is also a sensor's name", name),
                   "Choose a different name");
  (index == 0 ? session.board_name : session.further_boards.at(index - 1).name) = name;
  for (SessionCamera& camera : session.cameras)
    if (camera.board == before) camera.board = name;
}

void settleBoards(Session& session) {
  const bool several = !session.further_boards.empty();
  for (SessionCamera& camera : session.cameras) {
    if (several && camera.board.empty()) camera.board = session.board_name;
    if (!several && camera.board == session.board_name) camera.board.clear();
  }
  if (session.cameras.empty()) return;
  const std::size_t seen = session.boardIndexOf(session.worldCamera());
  if (seen > 0) makeWorlds(seen, session);
}

std::size_t Session::boardIndexOf(std::size_t camera) const {
  const std::string& name = cameras[camera].board;
  const auto found = std::find_if(further_boards.begin(), further_boards.end(),
                                  [&](const AdditionalBoard& each) { return each.name == name; });
  return found == further_boards.end() ? 0 : static_cast<std::size_t>(found - further_boards.begin()) + 1;
}

const Board& Session::boardOf(std::size_t camera) const {
  const std::size_t index = boardIndexOf(camera);
  return index == 0 ? board : further_boards[index - 1].board;
}

void validateBoards(const Session& session, const std::string& place) {
  checkSeen(session, place);
  for (std::size_t i = 0; i <= session.further_boards.size(); ++i)
    checkTurned(session, boardAt(session, i), place + ": " + boardKey(session, i));
}

std::string boardsYaml(const Session& session) {
  std::vector<std::string> first = boardLines(session.board, session.measured);
  if (session.board_blinks) first.emplace_back("blinking: true");
  if (!hasNamedBoards(session)) return "board:\n" + indented(first, 2);
  std::string text = fmt::format("boards:\n  {}:\n", yamlText(session.board_name)) + indented(first, 4);
  for (const SessionBoard& further : session.further_boards) {
    const bool by_length =
        tellsSpacing(further.measured, further.board) && further.spacing_std == spacingStd(further.measured);
    std::vector<std::string> lines =
        boardLines(further.board, by_length ? further.measured : std::optional<MeasuredLength>());
    if (further.spacing_std && !by_length)
      lines.push_back(fmt::format("spacing_std: {}", *further.spacing_std));
    text += fmt::format("  {}:\n", yamlText(further.name)) + indented(lines, 4);
  }
  return text;
}

CalibrationOptions optionsBesideBoards(const Session& session) {
  CalibrationOptions options = session.options;
  if (tellsSpacing(session.measured, session.board) && tellsSigma(session.measured, *options.optimisation))
    forgetSigma(options.optimisation.edit());
  return options;
}

}  // namespace evical
