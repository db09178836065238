// Input of a repeat: sessions of several recordings of one rig and one board.
#pragma once

#include "core/pipeline/session/session.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct RepeatInput {
  std::vector<Session> sessions;   // with the same sensors in the same order
  std::vector<std::string> names;  // of their recordings, unique and suitable for folders
};

// Reads sessions, or one that lists `recordings`. Throws CalibrationError (BadInput) for fewer than two
// recordings, missing or duplicate ones, and different rigs or boards.
RepeatInput readRepeat(std::span<const std::filesystem::path> files);

// The same for sessions and recordings. A recording has the sensors and the board of `like`, or of the first
// session among the files. Throws CalibrationError (BadInput) if there is no session.
RepeatInput readRepeat(std::span<const std::filesystem::path> files, const std::optional<Session>& like);

// The same for given sessions.
RepeatInput repeatOf(std::vector<Session> sessions);

}  // namespace evical
