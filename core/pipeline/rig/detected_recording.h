// What the front end found in a recording, ready for a calibration to start from: made before anybody asks for one, or
// by an earlier run.
#pragma once

#include "core/base/progress.h"
#include "core/data/intrinsics_result.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <optional>
#include <vector>

namespace evical {

struct DetectedRecording {
  DetectionResult pass;
  std::vector<std::optional<IntrinsicsResult>> intrinsics;  // as CalibrationRun has them
};

// All lenses of a session, with those calibrated that it leaves out.
struct FoundLenses {
  std::vector<CameraLens> lenses;
  std::vector<std::optional<IntrinsicsResult>> intrinsics;  // empty: it gives all
};
FoundLenses findLenses(const Session& session, const RunContext& context);

// As a calibration of this session begins. Throws CalibrationError, and Cancelled when asked to stop.
DetectedRecording detectRecording(const Session& session, const RunContext& context);

// Whether what was detected for one session is what the other would detect: they differ, if at all, in what comes
// later, as noise, priors, the optimisation, exports.
bool detectsTheSame(const Session& one, const Session& other);

// For a session that detects the same: with its noise.
DetectedRecording forSession(DetectedRecording detected, const Session& session);

}  // namespace evical
