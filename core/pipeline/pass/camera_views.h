// Views of the board of one camera, collected from its batches: by the front end from events, or measured by
// another program. Used by the window thread.
#pragma once

#include "core/base/progress.h"
#include "core/data/board_observations.h"
#include "core/data/camera_lens.h"
#include "core/data/recording_fault.h"
#include "core/pipeline/pass/camera_batch.h"
#include "core/pipeline/session/session.h"

#include <memory>
#include <vector>

namespace evical {

class CameraViews {
 public:
  virtual ~CameraViews() = default;
  virtual void consume(const CameraBatch& batch) = 0;
  virtual const BoardObservations& soFar() const = 0;
  // Observations in ideal pixels, or in raw pixels if the lens is unknown. Appends faults.
  virtual BoardObservations finish(std::vector<RecordingFault>& faults) = 0;
  // Resolution of frames; otherwise unknown.
  virtual Resolution resolution_px() const { return {}; }
};

// Inputs for a camera's views, which the first batch opens; all of them must outlive the views.
struct ViewRequest {
  const Session& session;
  const CameraLens& lens;
  const RunContext& context;
};
std::unique_ptr<CameraViews> cameraViews(const CameraBatch& first, const ViewRequest& request);

}  // namespace evical
