// Views of a blinking board from events.
#pragma once

#include "core/base/error.h"
#include "core/frames/blink_tracker.h"
#include "core/pipeline/pass/camera_views.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

class BlinkViews final : public CameraViews {
 public:
  BlinkViews(const CameraBatch& first, const ViewRequest& request);

  void consume(const CameraBatch& batch) override { tracker_.add(batch.events); }
  const BoardObservations& soFar() const override { return tracker_.soFar(); }
  // Throws CalibrationFailed if nothing blinks.
  BoardObservations finish(std::vector<RecordingFault>& faults) override;

 private:
  const SessionCamera& camera_;
  const RunContext& context_;
  std::optional<CameraIntrinsics> lens_;
  BlinkTracker tracker_;
};

// Error if the board was not found but something blinks; absent if nothing blinks, or if the session's board
// blinks. Reads the first seconds of the recording again.
std::optional<CalibrationError> unexpectedBlink(const Session& session, std::size_t camera);

// Throws CalibrationFailed if something blinks, but the board was never found in it.
void checkBlinkingBoardSeen(const BoardObservations& observations, const Board& board);

}  // namespace evical
