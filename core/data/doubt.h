// What makes a verdict doubtful.
#pragma once

#include "core/base/repair.h"
#include "core/data/calibration_status.h"

#include <optional>
#include <string>

namespace evical {

struct Doubt {
  std::string text;  // empty: there is none
  std::optional<Repair> repair = {};
};

// For what has a status and a reason. It comes first of the reasons: it is the one that people can mend; so is its
// repair, where the verdict has a place for one.
template <class Verdict>
void addDoubt(const Doubt& doubt, Verdict& verdict) {
  if (doubt.text.empty()) return;
  verdict.status = CalibrationStatus::Doubtful;
  verdict.reason = verdict.reason.empty() ? doubt.text : doubt.text + "; " + verdict.reason;
  if constexpr (requires { verdict.repair; }) verdict.repair = doubt.repair;
}
template <class Verdict>
void addDoubt(const std::string& doubt, Verdict& verdict) {
  addDoubt(Doubt{doubt}, verdict);
}

}  // namespace evical
