#include "core/pipeline/detection/camera_views.h"

#include "core/pipeline/detection/board_size_check.h"
#include "core/pipeline/detection/session_recording.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/frames/frame_options.h"
#include "core/frames/ideal_views.h"
#include "core/frontend/board_tracker.h"
#include "core/frontend/detection_options.h"
#include "core/recording/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace evical {
namespace {

// What a tracker noticed about the board.
template <typename Tracker>
void addRemarks(const Tracker& tracker, const SessionCamera& camera, std::vector<RecordingFault>& faults) {
  const auto add = [&](FaultKind kind, const std::string& text) {
    if (!text.empty()) faults.push_back({camera.stream, kind, 0.0, fmt::format("{}: {}", camera.name, text)});
  };
  add(FaultKind::BoardSize, tracker.doubt());
  add(FaultKind::Guess, tracker.remark());
}

class EventViews final : public CameraViews {
 public:
  EventViews(const CameraBatch& first, const ViewRequest& request)
      : camera_(request.session.cameras[first.camera]),
        tracker_(request.session.boardOf(first.camera), *first.opened_px, request.lens.detection_intrinsics,
                 *request.session.options.front_end, first.start_ns) {
    tracker_.stopWith(request.context.stop);
    if (request.context.observer != nullptr)
      tracker_.observeWith(request.context.observer->windowObserver(first.camera, tracker_));
  }

  void consume(const CameraBatch& batch) override {
    tracker_.addBursts(batch.bursts, batch.first_event_ns, batch.complete_until_ns);
  }
  const BoardObservations& soFar() const override { return tracker_.observations(); }
  BoardObservations finish(std::vector<RecordingFault>& faults) override {
    BoardObservations observations = tracker_.finish();
    addRemarks(tracker_, camera_, faults);
    return observations;
  }

 private:
  const SessionCamera& camera_;
  BoardTracker tracker_;
};

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
  return std::make_unique<EventViews>(first, request);
}

FrameViews::FrameViews(const CameraBatch& first, const ViewRequest& request)
    : camera_(request.session.cameras[first.camera]),
      context_(request.context),
      start_ns_(first.start_ns),
      lens_(request.lens.detection_intrinsics),
      tracker_(camera_.name, request.session.boardOf(first.camera), *request.session.options.frames),
      resolution_px_(*first.opened_px) {
  so_far_.kind = CameraKind::Frames;
}

void FrameViews::consume(const CameraBatch& batch) {
  for (const Frame& frame : batch.frames) {
    if (context_.stop.stop_requested()) return;
    see(frame, secondsSince(start_ns_, frame.time_ns));
  }
}

void FrameViews::see(const Frame& frame, double time_s) {
  const FrameTime time{time_s, frame.exposure_s};
  GrayImage image;
  try {
    image = decodeFrame(frame, fmt::format("{}: frame at {:.3f} s", camera_.stream, time_s));
  } catch (const CalibrationError& error) {
    if (unreadable_++ == 0) first_error_ = error;
    constexpr std::uint64_t kEnough = 10;
    if (decoded_ == 0 && unreadable_ >= kEnough) throw;
    tracker_.skipUnreadable(time);
    return;
  }
  checkSize(image);
  ++decoded_;
  tracker_.track(image, time);
}

void FrameViews::checkSize(const GrayImage& image) {
  if (!resolution_px_.known()) resolution_px_ = image.size_px;
  const auto size = [](const Resolution& r) { return fmt::format("{} x {} px", r.width_px, r.height_px); };
  if (image.size_px != resolution_px_)
    throw badInput(camera_.name,
                   fmt::format("its frames have {}, {} {}", size(image.size_px),
                               decoded_ == 0 ? "but its resolution_px is" : "but earlier frames had",
                               size(resolution_px_)),
                   "Give frames of one camera, with its resolution_px and intrinsics");
  if (lens_ && lens_->resolution_px.known() && lens_->resolution_px != image.size_px)
    throw badInput(camera_.name,
                   fmt::format("its intrinsics are for {}, but its frames have {}",
                               size(lens_->resolution_px), size(image.size_px)),
                   "Use intrinsics of this camera at this resolution, or remove them to calibrate them");
}

BoardObservations FrameViews::finish(std::vector<RecordingFault>& faults) {
  if (decoded_ == 0 && first_error_) throw CalibrationError(*first_error_);
  if (unreadable_ > 0)
    faults.push_back({camera_.stream, FaultKind::Corrupt, 0.0,
                      fmt::format("{}: {} of {} frames cannot be read: {}", camera_.stream, unreadable_,
                                  unreadable_ + decoded_, first_error_->what())});
  BoardObservations observations = tracker_.finish();
  observations.kind = CameraKind::Frames;
  addRemarks(tracker_, camera_, faults);
  return throughLens(std::move(observations), resolution_px_.height_px, lens_);
}

PointViews::PointViews(const CameraBatch& first, const ViewRequest& request)
    : board_(request.session.boardOf(first.camera)),
      stream_(request.session.cameras[first.camera].stream),
      resolution_px_(*first.opened_px),
      start_ns_(first.start_ns),
      unsaid_sigma_px_(request.session.options.frames->point_sigma_px),
      lens_(request.lens.detection_intrinsics) {
  so_far_.kind = CameraKind::Points;
}

bool PointViews::belongs(const MeasuredPoint& point) {
  ++seen_;
  if (point.point >= board_.pointCount()) {
    largest_ = std::max(largest_, point.point);
    ++unknown_;
    return false;
  }
  // Pixels extend half a pixel around their centres.
  const bool inside = point.x_px >= -0.5F && point.y_px >= -0.5F &&
                      point.x_px <= static_cast<float>(resolution_px_.width_px) - 0.5F &&
                      point.y_px <= static_cast<float>(resolution_px_.height_px) - 0.5F;
  outside_ += inside ? 0 : 1;
  return inside;
}

// A few invalid points are errors of the other program; many are of another board or another camera.
void PointViews::checkShare() const {
  constexpr std::uint64_t kEnough = 200, kMaxShare = 20;
  if (seen_ < kEnough) return;
  if (kMaxShare * unknown_ > seen_)
    throw badInput(
        stream_,
        fmt::format(
            "{} of {} points have indices beyond this board's: up to {}, but the board's points are 0 to {}",
            unknown_, seen_, largest_, board_.pointCount() - 1),
        board_.hasPattern()
            ? "Check type, rows and columns of the board. Points are counted row by row; an AprilGrid has "
              "four per tag, from the bottom left one"
            : "Give all points of the board in board.points_m, with the same indices as the camera's points");
  if (kMaxShare * outside_ > seen_)
    throw badInput(stream_,
                   fmt::format("{} of {} points are outside {} x {} px", outside_, seen_,
                               resolution_px_.width_px, resolution_px_.height_px),
                   "Give the camera's resolution_px, and points in its raw pixels");
}

// Each point once, in order of their indices.
FoundPoints PointViews::pointsOf(const CameraBatch& batch) {
  FoundPoints points;
  for (const MeasuredPoint& measured : batch.points) {
    if (!belongs(measured)) continue;
    const double sigma_px =
        measured.sigma_px > 0.0F ? static_cast<double>(measured.sigma_px) : unsaid_sigma_px_;
    FoundPoint& point = points.emplace_back();
    point.point = measured.point;
    point.at_px = Eigen::Vector2d(measured.x_px, measured.y_px);
    point.covariance_px2 = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
  }
  const auto before = [](const FoundPoint& a, const FoundPoint& b) { return a.point < b.point; };
  const auto same = [](const FoundPoint& a, const FoundPoint& b) { return a.point == b.point; };
  std::stable_sort(points.begin(), points.end(), before);
  const auto repeated = std::unique(points.begin(), points.end(), same);
  twice_ += static_cast<std::uint64_t>(points.end() - repeated);
  points.erase(repeated, points.end());
  return points;
}

void PointViews::consume(const CameraBatch& batch) {
  if (batch.points.empty()) return;
  PointsInFrame seen;
  seen.time_s = secondsSince(start_ns_, batch.points.front().time_ns);
  seen.points = pointsOf(batch);
  checkShare();
  constexpr int kMinPoints = 4;  // of a pose
  WindowReport window;
  window.time_s = seen.time_s;
  window.candidates = static_cast<int>(batch.points.size());
  window.circles = static_cast<int>(seen.points.size());
  window.outcome = window.circles < kMinPoints             ? WindowOutcome::TooFewCircles
                   : window.circles == board_.pointCount() ? WindowOutcome::Complete
                                                           : WindowOutcome::Partial;
  so_far_.windows.push_back(window);
  if (window.circles >= kMinPoints) frames_.push_back(std::move(seen));
}

BoardObservations PointViews::finish(std::vector<RecordingFault>& faults) {
  const auto earlier = [](const auto& a, const auto& b) { return a.time_s < b.time_s; };
  const auto say = [&](FaultKind kind, std::uint64_t count, const char* what) {
    if (count > 0)
      faults.push_back(
          {stream_, kind, 0.0, fmt::format("{}: {} {}", stream_, counted(count, "point"), what)});
  };
  if (!std::is_sorted(frames_.begin(), frames_.end(), earlier))
    faults.push_back({stream_, FaultKind::BackwardTime, 0.0, stream_ + ": views out of order were sorted"});
  std::stable_sort(frames_.begin(), frames_.end(), earlier);
  BoardObservations observations = so_far_;
  std::stable_sort(observations.windows.begin(), observations.windows.end(), earlier);
  say(FaultKind::Corrupt, unknown_, "excluded: the board does not have them");
  say(FaultKind::OutsideResolution, outside_, "excluded: outside the sensor");
  say(FaultKind::Corrupt, twice_, "excluded: measured twice at the same time");
  for (ViewFromFrame& made : viewsFromFrames(frames_, board_.pointCount()))
    observations.views.push_back(std::move(made.view));
  return throughLens(std::move(observations), resolution_px_.height_px, lens_);
}

BlinkViews::BlinkViews(const CameraBatch& first, const ViewRequest& request)
    : camera_(request.session.cameras[first.camera]),
      context_(request.context),
      lens_(request.lens.detection_intrinsics),
      tracker_(camera_.name, request.session.board, *first.opened_px, *request.session.options.frames,
               *request.session.options.blink, first.start_ns) {}

BoardObservations BlinkViews::finish(std::vector<RecordingFault>& faults) {
  const BoardObservations observations = tracker_.finish();
  const Blink& blink = *tracker_.blink();
  context_.progress.log(LogLevel::Info,
                        fmt::format("{}: blinks at {:.1f} Hz, {:.0f} % of the events; {} views of {} images",
                                    camera_.name, 1.0 / blink.period_s, 100.0 * blink.share,
                                    observations.views.size(), observations.windows.size()));
  addRemarks(tracker_, camera_, faults);
  return lens_ ? inIdealPixels(observations, *lens_) : observations;
}

void checkBlinkingBoardSeen(const BoardObservations& observations, const Board& board) {
  if (!observations.views.empty()) return;
  throw calibrationFailed(
      observations.camera,
      fmt::format("something blinks, but a {} of {} x {} was never found in {} images of its flashes ({})",
                  boardTypeName(board.type), board.rows, board.cols, observations.windows.size(),
                  outcomes(observations)),
      "Check type, rows and columns of the board. Check that it is in focus and large enough in the image, "
      "and that the camera is almost at rest");
}

std::optional<CalibrationError> unexpectedBlink(const Session& session, std::size_t camera) {
  constexpr double kLooks = 3.0;
  if (session.board_blinks) return std::nullopt;
  std::unique_ptr<SessionRecording> opened;
  try {
    opened = std::make_unique<SessionRecording>(session);
  } catch (const CalibrationError&) {
    return std::nullopt;  // the recording has been removed since the detection
  }
  SessionRecording& recording = *opened;
  if (recording.camera(camera).type != StreamType::Events) return std::nullopt;
  const Resolution size_px = recording.resolution_px(camera);
  const double begin_s = session.time_range_s ? session.time_range_s->front() : 0.0;
  const double end_s = begin_s + kLooks * session.options.blink->look_s;
  BlinkNotice notice(size_px, *session.options.blink);
  SensorPacket packet;
  std::int64_t last_ns = recording.start_ns();
  for (bool more = true; more && !notice.blink() && recording.read(packet);) {
    if (packet.sensor != camera) continue;
    std::erase_if(packet.events, [&](const Event& event) {
      const double time_s = secondsSince(recording.start_ns(), event.time_ns);
      more = more && time_s <= end_s;
      const bool backwards = event.time_ns < last_ns;
      last_ns = std::max(last_ns, event.time_ns);
      return backwards || time_s < begin_s || time_s > end_s || event.x_px >= size_px.width_px ||
             event.y_px >= size_px.height_px;
    });
    notice.add(packet.events);
  }
  notice.finish();
  if (!notice.blink()) return std::nullopt;
  return calibrationFailed(
      session.cameras[camera].name,
      fmt::format("the board was never found, but something blinks at {:.0f} Hz ({:.0f} % of the events)",
                  1.0 / notice.blink()->period_s, 100.0 * notice.blink()->share),
      "If the board is on a flashing screen, " + howTo(HowTo::SayThatBoardFlashes) +
          " and calibrate the camera " + howTo(HowTo::CalibrateLens) +
          ". If a lamp flickers, use daylight or a lamp with direct current");
}

}  // namespace evical
