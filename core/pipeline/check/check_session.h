// What a check starts from: an old result, and the session that calibrates the new recording as the old one was.
#pragma once

#include "core/pipeline/session/session.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

struct CheckPaths {
  std::filesystem::path result;     // result.yaml, or the folder of a run
  std::filesystem::path recording;  // or a session, which says all
  std::filesystem::path session;    // of the new recording; empty: the one that is kept beside the result
};

struct CheckInput {
  NamedResult before;
  Session session;
  bool same_board = true;
  std::vector<std::string> notes;
  std::string before_name;  // as people know it
};

// Throws CalibrationError (BadInput): the result is none, failed, or of another rig; there is no session.
CheckInput readCheckInput(const CheckPaths& paths);

// The same of a session that is there already.
CheckInput readCheckInput(const std::filesystem::path& result, Session session);

// Of a session that is there already: what it has of lenses comes from the result. Throws as above.
CheckInput checkInputOf(NamedResult before, Session session);

// The result as prior, each of its sigmas with what the quantity may move by itself.
Session withPriorOf(const NamedResult& before, Session session);

}  // namespace evical
