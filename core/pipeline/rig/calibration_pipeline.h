// From a session to a result: read and detect, initialise, optimise, judge. Defines the order of the stages.
//
//   const Session session = readSession("session.yaml");
//   const CalibrationResult result = calibrate(session, RunContext{}).result;
//   if (result.status == CalibrationStatus::Ok) use(result.state.cameras[0].reference_from_camera);
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

struct [[nodiscard]] CalibrationRun {
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
struct [[nodiscard]] CalibrationOutcome {
  RunStatus status = RunStatus::Done;
  std::optional<CalibrationError> error;  // why it failed
  std::optional<CalibrationRun> run;      // present if and only if status is Done
  DetectionResult detections;             // if not Done: data read and detected until then, or empty

  // The run. Throws the error, or Cancelled, if there is none.
  CalibrationRun runOrThrow() &&;
};

// Calibrates a session. Cameras without intrinsics are calibrated first, from the same events. Progress has
// the stages of core/data/calibration_observer.h; the observer of `context` receives the cameras' windows
// once all intrinsics are known. Returns the outcome of failed and cancelled runs, too, and does not throw
// for a recording that cannot be calibrated.
CalibrationOutcome runCalibration(const Session& session, const RunContext& context);

// The same from detections and IMU samples: `detections` from readAndDetect, restoreDetections or a
// simulation, with the lenses used for detection. `intrinsics`: results of an earlier run for lenses that
// were not given, see CalibrationRun.
CalibrationOutcome runCalibration(const Session& session, DetectionResult detections,
                                  const RunContext& context,
                                  std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

// Calibrates as runCalibration does, but returns only a run that is done. Throws CalibrationError for a
// session that cannot be calibrated, and Cancelled when asked to stop.
CalibrationRun calibrate(const Session& session, const RunContext& context);
CalibrationRun calibrate(const Session& session, DetectionResult detections, const RunContext& context,
                         std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

// Input and initial state of the batch.
struct [[nodiscard]] InitialisedCalibration {
  CalibrationInput input;
  Initialisation initial;
};

// Runs all checks and stages before the batch, and returns its input and start. Throws CalibrationError, and
// Cancelled when asked to stop.
InitialisedCalibration initialiseCalibration(const Session& session, DetectionResult detections,
                                             const RunContext& context,
                                             std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

}  // namespace evical
