// Detections of a recording, from which a calibration can start: made in advance, or by an earlier run.
#pragma once

#include "core/base/progress.h"
#include "core/data/intrinsics_result.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <optional>
#include <vector>

namespace evical {

struct DetectedRecording {
  DetectionResult detections;
  std::vector<std::optional<IntrinsicsResult>> intrinsics;  // as CalibrationRun has them
};

// All lenses of a session; those that it does not give are calibrated.
struct FoundLenses {
  std::vector<CameraLens> lenses;
  std::vector<std::optional<IntrinsicsResult>> intrinsics;  // empty: it gives all
};
FoundLenses findLenses(const Session& session, const RunContext& context);

// First stage of a calibration of this session. Throws CalibrationError, and Cancelled when asked to stop.
DetectedRecording detectRecording(const Session& session, const RunContext& context);

// True if both sessions differ only in names and rejected windows.
bool sameExceptNames(const Session& one, const Session& other);

// True if both sessions have the same detections: they differ only in names and in later stages (noise,
// priors, optimisation, exports).
bool detectsTheSame(const Session& one, const Session& other);

// Detections with names and IMU noise of `session`, which must detect the same.
DetectedRecording forSession(DetectedRecording detected, const Session& session);

}  // namespace evical
