// One camera's views of the board, gathered from its batches as they come: by the front end from events, or as
// another program has measured them. For the window thread.
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
  virtual void take(const CameraBatch& batch) = 0;
  virtual const BoardObservations& soFar() const = 0;
  // In the ideal pixels of the lens, or in the sensor's own where none is known. What is odd is appended.
  virtual BoardObservations finish(std::vector<RecordingFault>& faults) = 0;
  // What frames tell themselves; unknown of all else.
  virtual Resolution resolution_px() const { return {}; }
};

// For whom the first batch of a camera opens; all of it must live as long as the views are gathered.
struct ViewRequest {
  const Session& session;
  const CameraLens& lens;
  const RunContext& context;
};
std::unique_ptr<CameraViews> cameraViews(const CameraBatch& first, const ViewRequest& request);

}  // namespace evical
