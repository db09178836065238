// What a repeat starts from: sessions of several recordings of one rig before one board.
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
  std::vector<std::string> names;  // of their recordings, each another one, fit for folders
};

// Sessions, or one that lists `recordings`. Throws CalibrationError (BadInput): fewer than two recordings, one that is
// missing or there twice, rigs or boards that are not the same.
RepeatInput readRepeat(std::span<const std::filesystem::path> files);

// The same of sessions and recordings. Of a recording the sensors and the board are those of `like`; where there is none,
// of the first session among the files. Throws CalibrationError (BadInput) where no session says them.
RepeatInput readRepeat(std::span<const std::filesystem::path> files, const std::optional<Session>& like);

// The same of sessions that are there already.
RepeatInput repeatOf(std::vector<Session> sessions);

}  // namespace evical
