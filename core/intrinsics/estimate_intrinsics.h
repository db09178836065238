// Camera intrinsics from board views (docs/maths.md, 7): selection of views, start value, joint adjustment of
// intrinsics and poses, verdict.
//
// The centres of ellipses were fitted in the ideal pixels of `detection_intrinsics`. If that camera is far
// from the estimated one, they are not exactly the centres of true ellipses: run the front end again with the
// result, and repeat the estimate.
#pragma once

#include "core/base/progress.h"
#include "core/data/board_observations.h"
#include "core/data/intrinsics_result.h"
#include "core/geometry/board.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/intrinsics/sensor_views.h"

#include <optional>
#include <vector>

namespace evical {

struct IntrinsicsInput {
  const Board& board;
  Resolution resolution_px;
  const BoardObservations& observations;
  std::optional<CameraIntrinsics>
      detection_intrinsics;  // none: the observations are in the sensor's own pixels
  // Result of an earlier estimate, whose model is kept; none: a start value is found, and models are
  // compared.
  std::optional<CameraIntrinsics> start;
};

// The order of board.index is that of the views; for boards with half-turn symmetry either is correct. Throws
// CalibrationFailed, with advice, if the views do not determine a camera. `story` may be null.
IntrinsicsResult estimateIntrinsics(const IntrinsicsInput& input, const IntrinsicsOptions& options,
                                    const RunContext& context, IntrinsicsStory* story = nullptr);

// A camera that is accurate enough to detect the board.
struct RoughCamera {
  CameraIntrinsics intrinsics;
  double sigma_px = 0.0;  // of the projections of rays, RMS over the image
};

// The same without checks, from a few views; `guess` is a lens with which the board can be detected. Empty
// if the views do not determine a camera.
std::optional<RoughCamera> roughCamera(const std::vector<SensorView>& views, const Board& board,
                                       const CameraIntrinsics& guess, const IntrinsicsOptions& options,
                                       const RunContext& context);

}  // namespace evical
