// Intrinsics of a camera from the events of a session: initial intrinsics, then front end and bundle
// adjustment alternately, until circles refitted in undistorted pixels no longer change (docs/maths.md, 7).
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/intrinsics_result.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <cstddef>

namespace evical {

struct [[nodiscard]] IntrinsicsRun {
  IntrinsicsResult result;
  IntrinsicsStory story;       // models tried by the first pass, views used by the last one
  DetectionResult detections;  // the last one, of this camera only
};

// Calibrates one camera's lens, by its index in the session. Ignores the session's intrinsics of the camera,
// and its IMUs. Progress has the stages "first look" and, for
// each pass, "intrinsics". Observers receive the windows as those of camera 0, with times since the camera's
// own start. Throws CalibrationError, and Cancelled when asked to stop.
IntrinsicsRun calibrateIntrinsics(const Session& session, std::size_t camera, const RunContext& context);

// Intrinsics that were calibrated first, judged again after their refinement in the joint optimisation.

// `first` with the intrinsics, covariance and verdict of the joint solution; the coverage stays. Unchanged if
// the report does not contain the camera's intrinsics.
IntrinsicsResult jointIntrinsics(const IntrinsicsResult& first, std::size_t camera,
                                 const CameraIntrinsics& solved, const UncertaintyReport& report,
                                 const IntrinsicsOptions& options);

}  // namespace evical
