// Intrinsics of a camera from the events of a session: initial intrinsics, then front end and bundle
// adjustment alternately, until circles refitted in undistorted pixels no longer change (docs/maths.md, 7).
#pragma once

#include "core/base/progress.h"
#include "core/data/intrinsics_result.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <cstddef>

namespace evical {

struct IntrinsicsRun {
  IntrinsicsResult result;
  IntrinsicsStory story;       // models tried by the first pass, views used by the last one
  DetectionResult detections;  // the last one, of this camera only
};

// Ignores the session's intrinsics of the camera, and its IMUs. Progress has the stages "first look" and, for
// each pass, "intrinsics". Observers receive the windows as those of camera 0, with times since the camera's
// own start. Throws CalibrationError, and Cancelled when asked to stop.
IntrinsicsRun calibrateIntrinsics(const Session& session, std::size_t camera, const RunContext& context);

}  // namespace evical
