// What makes a verdict doubtful.
#pragma once

#include "core/data/calibration_status.h"

#include <string>

namespace evical {

// For what has a status and a reason; nothing where there is no doubt. It comes first of the reasons: it is
// the one that people can mend.
template <class Verdict>
void addDoubt(const std::string& doubt, Verdict& verdict) {
  if (doubt.empty()) return;
  verdict.status = CalibrationStatus::Doubtful;
  verdict.reason = verdict.reason.empty() ? doubt : doubt + "; " + verdict.reason;
}

}  // namespace evical
