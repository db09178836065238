// Camera intrinsics from board views (docs/maths.md, 7): views are chosen, a start is found, intrinsics and
// poses are adjusted together, and the result is judged.
//
// The centres of ellipses were fitted in the ideal pixels of `detection_intrinsics`. Where that is far from the camera
// as found, they are not quite the centres of true ellipses: let the front end see the events again with the
// result, and estimate once more.
#pragma once

#include "core/base/progress.h"
#include "core/data/board_observations.h"
#include "core/data/intrinsics_result.h"
#include "core/data/intrinsics_story.h"
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
  // Of an estimate before, whose model is kept; none: a start is found, and models are tried.
  std::optional<CameraIntrinsics> start;
};

// The order of board.index is that of the views; of boards that look the same upside down either will do.
// Throws CalibrationFailed, with what to do, where the views make no camera. `story`: where it is wanted.
IntrinsicsResult estimateIntrinsics(const IntrinsicsInput& input, const IntrinsicsOptions& options,
                                    const RunContext& context, IntrinsicsStory* story = nullptr);

// A camera that is good enough to see the board with.
struct RoughCamera {
  CameraIntrinsics intrinsics;
  double sigma_px = 0.0;  // of where rays are projected, RMS over the image
};

// The same without checks, from a handful of views; `guess` is a lens that shows the board somehow. Nothing
// where the views make no camera.
std::optional<RoughCamera> roughCamera(const std::vector<SensorView>& views, const Board& board,
                                       const CameraIntrinsics& guess, const IntrinsicsOptions& options,
                                       const RunContext& context);

}  // namespace evical
