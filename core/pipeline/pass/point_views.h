// Views from points of the board that another program has measured: points with the same timestamp form a
// view.
#pragma once

#include "core/frames/views_from_frames.h"
#include "core/pipeline/pass/camera_views.h"

#include <optional>
#include <string>
#include <vector>

namespace evical {

class PointViews final : public CameraViews {
 public:
  PointViews(const CameraBatch& first, const ViewRequest& request);

  // Throws BadInput if points do not belong to this board or this sensor.
  void consume(const CameraBatch& batch) override;
  const BoardObservations& soFar() const override { return so_far_; }
  BoardObservations finish(std::vector<RecordingFault>& faults) override;

 private:
  FoundPoints pointsOf(const CameraBatch& batch);
  bool belongs(const MeasuredPoint& point);
  void checkShare() const;

  const Board& board_;
  std::string stream_;
  Resolution resolution_px_;
  std::int64_t start_ns_;
  double unsaid_sigma_px_;
  std::optional<CameraIntrinsics> lens_;
  BoardObservations so_far_;  // without views, which are added at the end
  std::vector<PointsInFrame> frames_;
  std::uint64_t seen_ = 0, unknown_ = 0, outside_ = 0, twice_ = 0;
  int largest_ = 0;  // largest index that the board does not have
};

}  // namespace evical
