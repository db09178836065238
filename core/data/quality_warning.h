// What makes a verdict doubtful.
#pragma once

#include "core/base/repair.h"
#include "core/data/calibration_status.h"

#include <optional>
#include <string>

namespace evical {

struct QualityWarning {
  std::string text;  // empty: there is none
  std::optional<Repair> repair = {};
  std::string name = "other";  // one word for programs: "lens", "board_size"
  double explains = 0.0;       // the share of the misfit that is gone where this is let free; 0: not tried
};

// For what has a status and a reason. It comes first of the reasons: it is the one that people can mend; so is its
// repair, where the verdict has a place for one.
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
