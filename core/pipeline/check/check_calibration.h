// Check of an old calibration: the new recording is calibrated without and with the old result as prior, and
// the change of each quantity is tested.
#pragma once

#include "core/base/progress.h"
#include "core/data/assessment.h"
#include "core/pipeline/check/check_session.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <memory>

namespace evical {

struct CheckRun {
  CalibrationCheck check;
  std::shared_ptr<const CalibrationRun> run;  // without the prior; empty if it has no result
  DetectionResult detections;                 // if there is no run: data read and detected until then
};

// Name of the second run in progress, which has the old result as prior.
inline constexpr const char* kTogetherPart = "with the old result";

// Checks without a board (check_without_board.h) if the board is hardly ever seen, or if this is requested.
// An uninformative recording gives a verdict, not an error. Throws CalibrationError (BadInput) if it does not
// match the session, and Cancelled.
CheckRun checkCalibration(const CheckInput& input, const RunContext& context);

// The same from detections with the lenses of the old result.
CheckRun checkCalibration(const CheckInput& input, DetectionResult detections, const RunContext& context);

}  // namespace evical
