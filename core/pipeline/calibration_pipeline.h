// From a session to a result: read and detect, initialise, optimise, judge. The only place that knows the
// stages' order.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/intrinsics_result.h"
#include "core/pipeline/recording_pass.h"
#include "core/pipeline/session.h"

#include <optional>
#include <vector>

namespace evical {

struct CalibrationRun {
  CalibrationResult result;
  RecordingPass pass;
  // By camera: as calibrated first, where the session gave none. Empty: it gave all. What the batch made of
  // them is in the result's state.
  std::vector<std::optional<IntrinsicsResult>> intrinsics;
};

// Cameras without intrinsics are calibrated first, from the same events: stages "first look" and "intrinsics"
// for each of them. Then progress goes by the stages "detect", "initialise", "optimise", "cross_validate".
// Throws CalibrationError, and Cancelled when asked to stop.
CalibrationRun calibrate(const Session& session, const RunContext& context,
                         const ObserverFactory& observers = {}, CalibrationObserver* observer = nullptr);

// The same into `run`, as far as it gets: where it throws, what was read and detected is there already.
void calibrateInto(CalibrationRun& run, const Session& session, const RunContext& context,
                   const ObserverFactory& observers = {}, CalibrationObserver* observer = nullptr);

// The same from what the front end and the IMUs gave: `pass` as readAndDetect or a simulation makes it,
// through the session's intrinsics. `intrinsics`: those of them that a run before found, as CalibrationRun
// has them.
CalibrationRun calibrate(const Session& session, RecordingPass pass, const RunContext& context,
                         CalibrationObserver* observer = nullptr,
                         std::vector<std::optional<IntrinsicsResult>> intrinsics = {});

// A camera's intrinsics as the run has them at its end: solved with everything else, or as calibrated first.
// Nothing where they stayed as the session gives them.
std::optional<CameraIntrinsics> foundIntrinsics(const CalibrationRun& run, std::size_t camera);

// How much of the process's memory was in use at most, in MB (10^6 bytes); 0 where the system does not say.
double peakMemory_mb();

}  // namespace evical
