// Events of a blinking board as views of it.
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

  void take(const CameraBatch& batch) override { tracker_.add(batch.events); }
  const BoardObservations& soFar() const override { return tracker_.soFar(); }
  // Throws CalibrationFailed where nothing blinks.
  BoardObservations finish(std::vector<RecordingFault>& faults) override;

 private:
  const SessionCamera& camera_;
  const RunContext& context_;
  std::optional<CameraIntrinsics> lens_;
  BlinkTracker tracker_;
};

// Why the board was not found in events in which something blinks; nothing where nothing does, or where the
// session says that the board blinks. Reads the recording's first seconds once more.
std::optional<CalibrationError> unexpectedBlink(const Session& session, std::size_t camera);

// Throws CalibrationFailed where something blinks, but never showed the board.
void checkBlinkingBoardSeen(const BoardObservations& observations, const Board& board);

}  // namespace evical
