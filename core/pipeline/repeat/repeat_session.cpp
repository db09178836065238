#include "core/pipeline/repeat/repeat_session.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/session_keys.h"
#include "core/pipeline/session/session_of_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace evical {
namespace {

[[noreturn]] void throwOther(const Session& session, const Session& first, const std::string& what,
                             const std::string& own, const std::string& other) {
  throw badInput(session.source.string(),
                 fmt::format("{} {}, that of {} {}: these are not recordings of one rig and one board", what,
                             own, first.source.string(), other),
                 "Use only recordings with the same sensors, the same names and the same board");
}

template <class Sensors>
std::string namesOf(const Sensors& sensors) {
  std::vector<std::string> names;
  for (const auto& sensor : sensors) names.push_back(sensor.name);
  std::sort(names.begin(), names.end());
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// Sorts sensors in the order of the first session.
template <class Sensors>
void sortAs(const Sensors& first, const std::string& what, const Session& first_session,
            const Session& session, Sensors& sensors) {
  const std::string own = namesOf(sensors), other = namesOf(first);
  if (own != other) throwOther(session, first_session, "the list of its " + what, "is " + own, "is " + other);
  Sensors sorted;
  for (const auto& wanted : first)
    sorted.push_back(*std::find_if(sensors.begin(), sensors.end(),
                                   [&](const auto& each) { return each.name == wanted.name; }));
  sensors = std::move(sorted);
}

std::string boardText(const Board& board) {
  if (!board.hasPattern()) return fmt::format("{} points", board.pointCount());
  return fmt::format("{} {} x {}, {:.6g} m apart", kBoardTypeNames[static_cast<std::size_t>(board.type)],
                     board.rows, board.cols, board.spacing_m);
}

// Given lenses are priors, which are counted once. Streams, clocks and columns may differ.
void checkCameras(const Session& first, const Session& session) {
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const SessionCamera &own = session.cameras[k], &other = first.cameras[k];
    const std::string camera = fmt::format("its camera {}", own.name);
    if (own.resolution_px.known() && other.resolution_px.known() && own.resolution_px != other.resolution_px)
      throwOther(session, first, "the image of " + camera, "has " + sizeText(own.resolution_px),
                 "has " + sizeText(other.resolution_px));
    if (own.intrinsics && other.intrinsics && own.intrinsics->model != other.intrinsics->model)
      throwOther(session, first, "the lens of " + camera,
                 std::string("is ") + cameraModelTitle(own.intrinsics->model),
                 std::string("is ") + cameraModelTitle(other.intrinsics->model));
    if (own.intrinsics != other.intrinsics || own.intrinsics_uncertainty != other.intrinsics_uncertainty)
      throwOther(session, first, "the given lens of " + camera, "differs",
                 "is another one: give the same lens in all, or none");
    if (own.same_sensor_as != other.same_sensor_as || own.shutter != other.shutter ||
        own.board != other.board)
      throwOther(session, first, camera, "has another board, shutter or same_sensor_as", "does not");
  }
}

// Priors must be the same in all sessions, since they are counted once.
void checkPriors(const Session& first, const Session& session) {
  const auto samePrior = [](const auto& a, const auto& b) { return a.prior == b.prior; };
  if (!std::equal(session.cameras.begin(), session.cameras.end(), first.cameras.begin(), samePrior) ||
      !std::equal(session.imus.begin(), session.imus.end(), first.imus.begin(), samePrior))
    throwOther(session, first, "its prior", "differs", "is another one: give the same prior in all");
}

// Options after the detection affect the meaning of a result and its sigmas, so they must be the same for
// all.
void checkOptions(const Session& first, const Session& session) {
  const auto rowsOf = [](const Session& of) {
    std::map<std::string, std::string> rows;
    for (const OptionRow& row : differingOptions(of.options))
      for (const char* const group : {"intrinsics.", "initialisation.", "optimisation.model.",
                                      "optimisation.priors.", "optimisation.verdict."})
        if (nameInTables(row.name).starts_with(group)) rows[row.name] = row.value;
    return rows;
  };
  const std::map<std::string, std::string> own = rowsOf(session), other = rowsOf(first);
  std::set<std::string> names;
  for (const auto& rows : {own, other})
    for (const auto& [name, value] : rows) names.insert(name);
  const auto valueIn = [](const auto& rows, const std::string& name) {
    const auto found = rows.find(name);
    return found == rows.end() ? std::string("its default") : found->second;
  };
  for (const std::string& name : names)
    if (valueIn(own, name) != valueIn(other, name))
      throw badInput(
          session.source.string(),
          fmt::format(
              "{} is {}, but in {} it is {}: results computed with different options cannot be combined",
              name, valueIn(own, name), first.source.string(), valueIn(other, name)),
          "Give all sessions the same options");
}

double spacingSigma(const SessionBoard& board, const Session& session) {
  return board.spacing_std.value_or(session.options.optimisation->board_spacing_sigma);
}

void checkBoards(const Session& first, const Session& session) {
  if (session.board != first.board)
    throwOther(session, first, "its board", "is " + boardText(session.board), "is " + boardText(first.board));
  for (std::size_t k = 0; k < session.further_boards.size(); ++k) {
    const SessionBoard &own = session.further_boards[k], &other = first.further_boards[k];
    const std::string board = "its board " + own.name;
    if (own.board != other.board)
      throwOther(session, first, board, "is " + boardText(own.board), "is " + boardText(other.board));
    const double own_std = spacingSigma(own, session), other_std = spacingSigma(other, first);
    if (own_std != other_std)
      throwOther(session, first, board, fmt::format("has a spacing_std of {}", own_std),
                 fmt::format("has {}", other_std));
  }
}

void makeLike(const Session& first, Session& session) {
  sortAs(first.cameras, "cameras", first, session, session.cameras);
  sortAs(first.imus, "IMUs", first, session, session.imus);
  sortAs(first.further_boards, "further boards", first, session, session.further_boards);
  if (session.reference != first.reference)
    throwOther(session, first, "its reference", "is " + session.reference, "is " + first.reference);
  if (session.board_name != first.board_name)
    throwOther(session, first, "its board", "is called " + session.board_name,
               "is called " + first.board_name);
  checkBoards(first, session);
  checkCameras(first, session);
  checkPriors(first, session);
  checkOptions(first, session);
}

void checkApart(const std::vector<Session>& sessions) {
  for (std::size_t k = 1; k < sessions.size(); ++k)
    for (std::size_t j = 0; j < k; ++j) {
      const std::optional<std::filesystem::path> twice = sharedRecording(sessions[k], sessions[j]);
      if (!twice) continue;
      throw badInput(twice->string(),
                     fmt::format("is listed twice ({} and {}): a duplicate adds no information",
                                 sessions[j].source.string(), sessions[k].source.string()),
                     "Name each recording once, or select parts of it that do not overlap by " +
                         howTo(HowTo::LimitTime));
    }
}

std::vector<std::string> namesFor(const std::vector<Session>& sessions) {
  std::vector<std::filesystem::path> recordings;
  for (const Session& session : sessions) recordings.push_back(session.recording);
  return distinctNames(recordings);
}

}  // namespace

RepeatInput repeatOf(std::vector<Session> sessions) {
  if (sessions.size() < 2)
    throw badInput(sessions.empty() ? std::string("repeat") : sessions.front().source.string(),
                   "is a single recording, which cannot be compared with others",
                   "Give two or more sessions, or one with a list of recordings");
  for (Session& session : sessions) {
    if (session.board_blinks)
      throw badInput(session.source.string() + ": board.blinking",
                     "a blinking board is not suitable for a rig", "Record with a printed board");
    if (&session != &sessions.front()) makeLike(sessions.front(), session);
  }
  checkApart(sessions);
  std::vector<std::string> names = namesFor(sessions);
  return {std::move(sessions), std::move(names)};
}

RepeatInput readRepeat(std::span<const std::filesystem::path> files) {
  std::vector<Session> sessions;
  for (const std::filesystem::path& file : files)
    for (Session& session : readRepeatedSessions(file)) sessions.push_back(std::move(session));
  return repeatOf(std::move(sessions));
}

RepeatInput readRepeat(std::span<const std::filesystem::path> files, const std::optional<Session>& like) {
  std::vector<std::vector<Session>> of_files;
  std::optional<Session> rig = like;
  for (const std::filesystem::path& file : files) {
    of_files.push_back(isSessionFile(file) ? readRepeatedSessions(file) : std::vector<Session>());
    if (!rig && !of_files.back().empty()) rig = of_files.back().front();
  }
  std::vector<Session> sessions;
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (isSessionFile(files[k])) {
      std::move(of_files[k].begin(), of_files[k].end(), std::back_inserter(sessions));
      continue;
    }
    if (!rig)
      throw badInput(files[k].string(), "is a recording without a description of its sensors and its board",
                     "Add a session of one of the recordings, or open one");
    Session session = *rig;
    setRecording(files[k], session);
    session.source = files[k];
    sessions.push_back(std::move(session));
  }
  return repeatOf(std::move(sessions));
}

}  // namespace evical
