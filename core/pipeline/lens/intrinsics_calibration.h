// A camera's intrinsics from the events of a session: a first look, then the front end and the bundle
// adjustment in turns, until circles refitted in undistorted pixels change nothing more (docs/maths.md, 7).
#pragma once

#include "core/base/progress.h"
#include "core/data/intrinsics_result.h"
#include "core/data/intrinsics_story.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <cstddef>

namespace evical {

struct IntrinsicsRun {
  IntrinsicsResult result;
  IntrinsicsStory story;  // models as the first pass tried them, views as the last one used them
  DetectionResult pass;   // the last one, of this camera alone
};

// What the session says of the camera's intrinsics, and its IMUs, are left aside. Progress goes by the stages
// "first look" and, once a pass, "intrinsics"; who watches sees the windows of a camera 0, in time from the
// camera's own start. Throws CalibrationError, and Cancelled when asked to stop.
IntrinsicsRun calibrateIntrinsics(const Session& session, std::size_t camera, const RunContext& context);

}  // namespace evical
