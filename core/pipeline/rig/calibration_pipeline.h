// From a session to a result: read and detect, initialise, optimise, judge. Defines the order of the stages.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/intrinsics_result.h"
#include "core/initialisation/initialise.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <optional>
#include <vector>

namespace evical {

struct CalibrationRun {
  CalibrationResult result;
  DetectionResult detections;
  // By camera: calibration of a lens that the session does not give. Empty: all are given. The lens in use is
  // in the result's state.
  std::vector<std::optional<IntrinsicsResult>> intrinsics;
  // Inverse of the normal equations, in the order of the result's uncertainty: weight of its data relative to
  // others'. Empty in a run that was read back.
  Eigen::MatrixXd as_weighed = {};
};

enum class RunStatus { Done, Cancelled, Failed };

// Status of a run, and its results as far as available.
struct CalibrationOutcome {
  RunStatus status = RunStatus::Done;
  std::optional<CalibrationError> error;  // why it failed
  std::optional<CalibrationRun> run;      // present if and only if status is Done
  DetectionResult detections;             // if not Done: data read and detected until then, or empty

  CalibrationRun runOrThrow() &&;  // throws the error, or Cancelled, if there is no run
};

// Calibrates a session. Cameras without intrinsics are calibrated first, from the same events. Progress has
// the stages of core/data/calibration_observer.h; the observer of `context` receives the cameras' windows
// once all intrinsics are known.
CalibrationOutcome runCalibration(const Session& session, const RunContext& context);

// The same from detections and IMU samples: `pass` from readAndDetect, restoreDetections or a simulation,
// with the lenses used for detection. `intrinsics`: results of an earlier run for lenses that were not given,
// see CalibrationRun.
CalibrationOutcome runCalibration(const Session& session, DetectionResult detections,
                                  const RunContext& context,
                                  std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

// Both without an outcome: they return the run. Throw CalibrationError, and Cancelled when asked to stop.
CalibrationRun calibrate(const Session& session, const RunContext& context);
CalibrationRun calibrate(const Session& session, DetectionResult detections, const RunContext& context,
                         std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

// Input and initial state of the batch.
struct InitialisedCalibration {
  CalibrationInput input;
  Initialisation initial;
};

// Runs all checks and stages before the batch. Throws CalibrationError, and Cancelled when asked to stop.
InitialisedCalibration initialiseCalibration(const Session& session, DetectionResult detections,
                                             const RunContext& context,
                                             std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

}  // namespace evical
