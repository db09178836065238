// A simulated recording calibrated in memory as by `evical calibrate`, against its truth.
#pragma once

#include "core/data/calibration_result.h"
#include "core/pipeline/session/session.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario.h"

#include <functional>
#include <optional>
#include <string>

namespace evical {

struct Outcome {
  std::string verdict, weakest, reason;
  double windows_found = 0.0;  // of those with enough of the board in view
  double events_per_s = 0.0;
  double detect_s = 0.0, solve_s = 0.0;
  std::optional<TruthComparison> comparison;
  std::optional<CameraUncertainty> uncertainty;  // of the camera whose translation is least certain
  std::optional<CalibrationResult> result;
};

// `change` modifies the session that matches the scenario, before the calibration.
Outcome runScenario(const Scenario& scenario, const std::function<void(Session&)>& change = {});

CalibrationState trueState(const Scenario& scenario);

// Fraction of the distance from the principal point to the furthest image corner at which a lens of 190
// degrees ends.
double shareOfImageCircle(const CameraIntrinsics& camera);

}  // namespace evical
