// Views of the board of one camera, collected from its batches: by the front end from events, or measured by
// another program. Used by the window thread.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/data/board_observations.h"
#include "core/data/camera_lens.h"
#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/data/recording.h"
#include "core/frames/blink_tracker.h"
#include "core/frames/frame_tracker.h"
#include "core/frames/views_from_frames.h"
#include "core/frontend/edge_crossings.h"
#include "core/geometry/resolution.h"
#include "core/pipeline/session/session.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Data of one camera that the reading thread passes to the window thread.
struct CameraBatch {
  std::size_t camera = 0;
  std::vector<EdgeCrossing> bursts;
  std::int64_t first_event_ns = 0, complete_until_ns = 0;
  std::vector<Event> events;  // for a blinking board, instead of bursts
  std::vector<Frame> frames;
  std::vector<MeasuredPoint> points;  // with the same timestamp
  // Set in a camera's first batch.
  std::optional<Resolution> opened_px;
  CameraKind kind = CameraKind::Events;
  std::int64_t start_ns = 0;
};

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

// Views of the board from frames, which were chosen by their rate: decoded, searched, tracked.
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
  std::optional<CalibrationError> first_error_;
};

// Views from points of the board that another program has measured: points with the same timestamp form a
// view.
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

// Views of a blinking board from events.
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
