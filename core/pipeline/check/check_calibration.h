// Whether an old calibration still holds: the new recording is calibrated freely, and with the old result as prior,
// and each quantity's change is tested.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_check.h"
#include "core/pipeline/check/check_session.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <memory>

namespace evical {

struct CheckRun {
  CalibrationCheck check;
  std::shared_ptr<const CalibrationRun> run;  // the free one; empty where there is none
  DetectionResult pass;                       // where there is none: what was read and detected until then
};

// The part of the second run, which has the old result as prior.
inline constexpr const char* kTogetherPart = "with the old result";

// Where the board is hardly ever seen, or is not to be looked for, that of check_without_board.h. A recording that tells
// nothing is a verdict, no error. Throws CalibrationError (BadInput) where it cannot be read as
// the session says, and Cancelled.
CheckRun checkCalibration(const CheckInput& input, const RunContext& context);

// The same from what was detected, through the lenses of the old result.
CheckRun checkCalibration(const CheckInput& input, DetectionResult pass, const RunContext& context);

}  // namespace evical
