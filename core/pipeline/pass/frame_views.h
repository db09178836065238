// Views of the board from frames, which were chosen by their rate: decoded, searched, tracked.
#pragma once

#include "core/frames/frame_tracker.h"
#include "core/pipeline/pass/camera_views.h"

#include <cstdint>
#include <string>

namespace evical {

class FrameViews final : public CameraViews {
 public:
  FrameViews(const CameraBatch& first, const ViewRequest& request);

  // Throws BadInput if images have another size than the session's, if their size changes, or if none can be
  // read.
  void consume(const CameraBatch& batch) override;
  const BoardObservations& soFar() const override { return so_far_; }
  BoardObservations finish(std::vector<RecordingFault>& faults) override;
  Resolution resolution_px() const override { return resolution_px_; }

 private:
  void see(const Frame& frame, double time_s);
  void checkSize(const GrayImage& image);

  const SessionCamera& camera_;
  const RunContext& context_;
  std::int64_t start_ns_;
  std::optional<CameraIntrinsics> lens_;
  FrameTracker tracker_;
  Resolution resolution_px_;
  BoardObservations so_far_;  // without views, which are added at the end
  std::uint64_t decoded_ = 0, unreadable_ = 0;
  std::string first_problem_;
};

}  // namespace evical
