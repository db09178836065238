// Input of a check: an old result, and a session that calibrates the new recording in the same way.
#pragma once

#include "core/pipeline/session/session.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

struct CheckPaths {
  std::filesystem::path result;     // result.yaml, or the folder of a run
  std::filesystem::path recording;  // or a complete session
  std::filesystem::path session;    // of the new recording; empty: the one stored with the result
};

struct CheckInput {
  NamedResult before;
  Session session;
  bool same_board = true;
  bool duplicate = false;  // the new recording is the old one
  std::vector<std::string> notes;
  std::string before_name;  // displayed name
};

// Throws CalibrationError (BadInput) if the result is missing, failed, or of another rig, or without a
// session.
CheckInput readCheckInput(const CheckPaths& paths);

// The same with a given session.
CheckInput readCheckInput(const std::filesystem::path& result, Session session);

// The same with a given result and session, whose lenses are replaced by the result's. Throws as above.
CheckInput checkInputOf(NamedResult before, Session session);

// Session with the result as prior; each sigma includes the quantity's allowed drift.
Session withPriorOf(const NamedResult& before, Session session);

}  // namespace evical
