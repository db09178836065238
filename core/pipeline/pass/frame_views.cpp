#include "core/pipeline/pass/frame_views.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/frames/frame_options.h"
#include "core/frames/ideal_views.h"

#include <fmt/format.h>

#include <utility>

namespace evical {

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
    if (unreadable_++ == 0) first_problem_ = error.what();
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
  if (unreadable_ > 0)
    faults.push_back({camera_.stream, FaultKind::Corrupt, 0.0,
                      fmt::format("{}: {} of {} frames cannot be read: {}", camera_.stream, unreadable_,
                                  unreadable_ + decoded_, first_problem_)});
  BoardObservations observations = tracker_.finish();
  observations.kind = CameraKind::Frames;
  if (const std::string doubt = tracker_.doubt(); !doubt.empty())
    faults.push_back({camera_.stream, FaultKind::BoardSize, 0.0, fmt::format("{}: {}", camera_.name, doubt)});
  if (const std::string remark = tracker_.remark(); !remark.empty())
    faults.push_back({camera_.stream, FaultKind::Guess, 0.0, fmt::format("{}: {}", camera_.name, remark)});
  return throughLens(std::move(observations), resolution_px_.height_px, lens_);
}

}  // namespace evical
