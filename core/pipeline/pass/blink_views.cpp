#include "core/pipeline/pass/blink_views.h"

#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/frames/blink_options.h"
#include "core/frames/frame_options.h"
#include "core/frames/ideal_views.h"
#include "core/pipeline/pass/board_size_check.h"
#include "core/pipeline/pass/session_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace evical {

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
  if (const std::string doubt = tracker_.doubt(); !doubt.empty())
    faults.push_back({camera_.stream, FaultKind::BoardSize, 0.0, fmt::format("{}: {}", camera_.name, doubt)});
  if (const std::string remark = tracker_.remark(); !remark.empty())
    faults.push_back({camera_.stream, FaultKind::Guess, 0.0, fmt::format("{}: {}", camera_.name, remark)});
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
