#include "core/pipeline/pass/camera_views.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/data/calibration_observer.h"
#include "core/frontend/board_tracker.h"
#include "core/frontend/front_end_options.h"
#include "core/pipeline/pass/blink_views.h"
#include "core/pipeline/pass/frame_views.h"
#include "core/pipeline/pass/point_views.h"
#include "core/recording/recording_reader.h"

namespace evical {
namespace {

class EventViews final : public CameraViews {
 public:
  EventViews(const CameraBatch& first, const ViewRequest& request)
      : tracker_(request.session.boardOf(first.camera), *first.opened_px, request.lens.detection_intrinsics,
                 *request.session.options.front_end, first.start_ns) {
    tracker_.stopWith(request.context.stop);
    if (request.context.observer != nullptr)
      tracker_.observeWith(request.context.observer->windowObserver(first.camera, tracker_));
  }

  void consume(const CameraBatch& batch) override {
    tracker_.addBursts(batch.bursts, batch.first_event_ns, batch.complete_until_ns);
  }
  const BoardObservations& soFar() const override { return tracker_.observations(); }
  BoardObservations finish(std::vector<RecordingFault>& /*faults*/) override { return tracker_.finish(); }

 private:
  BoardTracker tracker_;
};

// "calibrate the sensor's frames (stream /davis/image_raw)", which show boards that events cannot.
std::string framesInstead(const Session& session, const SessionCamera& camera) {
  std::string names;
  try {
    const std::unique_ptr<RecordingReader> reader =
        openRecording(camera.recording.empty() ? session.recording : camera.recording);
    for (const StreamInfo& stream : reader->streams())
      if (stream.type == StreamType::Frames) names += (names.empty() ? "" : ", ") + stream.name;
  } catch (const CalibrationError&) {
    names.clear();  // the general advice is enough
  }
  return names.empty() ? "calibrate frames of the same sensor"
                       : "calibrate the sensor's frames (stream " + names + ")";
}

}  // namespace

std::unique_ptr<CameraViews> cameraViews(const CameraBatch& first, const ViewRequest& request) {
  const Session& session = request.session;
  if (first.kind == CameraKind::Points) return std::make_unique<PointViews>(first, request);
  const Board& board = session.boardOf(first.camera);
  if (!board.hasPattern())
    throw badInput(session.cameras[first.camera].name,
                   "its board is a table of points, which has no detectable pattern",
                   "Give the camera points from another program (points: FILE), or use another board");
  if (first.kind == CameraKind::Frames) return std::make_unique<FrameViews>(first, request);
  if (session.board_blinks) return std::make_unique<BlinkViews>(first, request);
  if (!board.hasCircles())
    throw badInput(
        session.cameras[first.camera].name,
        std::string("a moving event camera cannot detect a board of type ") + boardTypeName(board.type),
        "Use a circle grid, " + framesInstead(session, session.cameras[first.camera]) +
            ", or show this board on a flashing screen (create a page for it " +
            howTo(HowTo::MakeFlashingPage) + "), " + howTo(HowTo::SayThatBoardFlashes) +
            " and calibrate the camera " + howTo(HowTo::CalibrateLens));
  return std::make_unique<EventViews>(first, request);
}

}  // namespace evical
