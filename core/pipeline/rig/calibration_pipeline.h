// From a session to a result: read and detect, initialise, optimise, judge. The only place
// that knows the stages' order.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/intrinsics_result.h"
#include "core/initialisation/initialise.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <optional>
#include <vector>

namespace evical {

struct CalibrationRun {
  CalibrationResult result;
  DetectionResult pass;
  // By camera: how the lens was calibrated first, where the session gave none. Empty: it gave all. The lens
  // in use is in the result's state.
  std::vector<std::optional<IntrinsicsResult>> intrinsics;
  // Inverse of the normal equations, in the order of the result's uncertainty: what its data weigh beside others'.
  // Empty in a run that was read back.
  Eigen::MatrixXd as_weighed = {};
};

enum class RunStatus { Done, Cancelled, Failed };

// How a run ended, and what there is of it.
struct CalibrationOutcome {
  RunStatus status = RunStatus::Done;
  std::optional<CalibrationError> error;  // why it failed
  std::optional<CalibrationRun> run;      // exactly where it is done
  DetectionResult pass;  // where it is not: what was read and detected until then; empty before that

  CalibrationRun runOrThrow() &&;  // the run; else throws the error, or Cancelled
};

// Cameras without intrinsics are calibrated first, from the same events. Progress goes by the
// stages of core/data/calibration_stage.h; the observer of `context` sees the cameras' windows
// once all intrinsics are known.
CalibrationOutcome runCalibration(const Session& session, const RunContext& context);

// The same from what the front end and the IMUs gave: `pass` as readAndDetect, restoreDetections or a simulation
// makes it, with the lenses that it was seen with. `intrinsics`: how a run before found those of them that were not
// given, as CalibrationRun has them.
CalibrationOutcome runCalibration(const Session& session, DetectionResult pass, const RunContext& context,
                                  std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

// Both for who wants nothing but the result. Throw CalibrationError, and Cancelled when asked to stop.
CalibrationRun calibrate(const Session& session, const RunContext& context);
CalibrationRun calibrate(const Session& session, DetectionResult pass, const RunContext& context,
                         std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

// What a calibration has before its batch.
struct InitialisedCalibration {
  CalibrationInput input;
  Initialisation initial;
};

// Goes that far and no further, with all that is checked on the way. Throws CalibrationError, and Cancelled when asked
// to stop.
InitialisedCalibration initialiseCalibration(const Session& session, DetectionResult pass,
                                             const RunContext& context,
                                             std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

}  // namespace evical
