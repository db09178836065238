// Reasons for a doubtful verdict.
#pragma once

#include "core/base/repair.h"
#include "core/data/calibration_status.h"

#include <optional>
#include <string>

namespace evical {

struct QualityWarning {
  std::string text;  // may be empty
  std::optional<Repair> repair = {};
  std::string name = "other";  // one word for programs: "lens", "board_size"
  double explains = 0.0;       // share of the misfit that is removed if this is estimated; 0: not tested
};

// Adds a reason to a verdict (a struct with status and reason). It becomes the first reason, since the user
// can fix it; so does its repair, if the verdict has a member for it.
template <class Verdict>
void flagDoubtful(const QualityWarning& doubt, Verdict& verdict) {
  if (doubt.text.empty()) return;
  verdict.status = CalibrationStatus::Doubtful;
  verdict.reason = verdict.reason.empty() ? doubt.text : doubt.text + "; " + verdict.reason;
  if constexpr (requires { verdict.repair; }) verdict.repair = doubt.repair;
  if constexpr (requires { verdict.causes; }) verdict.causes.insert(verdict.causes.begin(), doubt);
}
template <class Verdict>
void flagDoubtful(const std::string& doubt, Verdict& verdict, const char* name = "other") {
  flagDoubtful(QualityWarning{doubt, {}, name}, verdict);
}

}  // namespace evical
