#include "core/pipeline/detection/event_intake.h"

#include "core/base/error.h"
#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {

std::optional<CameraBatch> EventIntake::consume(std::vector<Event>& events) {
  putInOrder(events);
  if (events.empty()) return std::nullopt;
  CameraBatch batch;
  if (count_ == 0) {
    batch.opened_px = resolution_px_;
    if (use_ == EventUse::Bursts) extractor_.emplace(resolution_px_, burst_options_);
  }
  count_ += events.size();
  stamp_step_.add(events);
  load_.add(events);
  batch.camera = camera_;
  batch.first_event_ns = events.front().time_ns;
  batch.complete_until_ns = last_ns_ = events.back().time_ns;
  if (extractor_) {
    extractor_->add(events, batch.bursts);
    batch.complete_until_ns = extractor_->completeUntil_ns();
  } else {
    batch.events = std::move(events);
  }
  return batch;
}

std::optional<CameraBatch> EventIntake::flush() {
  if (!extractor_) return std::nullopt;
  CameraBatch batch;
  batch.camera = camera_;
  extractor_->finish(batch.bursts);
  batch.first_event_ns = batch.complete_until_ns = last_ns_;
  return batch;
}

void EventIntake::report(std::vector<RecordingFault>& faults) const {
  if (unsorted_ > 0) {
    faults.push_back({session_.stream, FaultKind::BackwardTime, 0.0,
                      fmt::format("{}: {} out of order {} sorted", session_.stream,
                                  counted(unsorted_, "event"), unsorted_ == 1 ? "was" : "were")});
  }
  if (late_ > 0) {
    faults.push_back({session_.stream, FaultKind::BackwardTime, 0.0,
                      fmt::format("{}: time runs backwards: {} excluded", session_.stream,
                                  counted(late_, "event", "was", "were"))});
  }
  if (const double step_s = stampStep_s(); step_s > 0.0)
    faults.push_back({session_.stream, FaultKind::Encoding, 0.0,
                      fmt::format("{}: timestamps of events have a resolution of {:.3g} ms, so the time "
                                  "offset is uncertain by half of that",
                                  session_.stream, 1e3 * step_s)});
  if (const ReadOutLoad::Limit limit = load_.limit(); limit.share > 0.0)
    faults.push_back(
        {session_.stream, FaultKind::SaturatedReadOut, 0.0,
         fmt::format(
             "{}: for {:.0f} % of the time, events arrive at {:.2g} million per second and never faster. The "
             "read-out is at its limit: events are lost, and others have late timestamps, which shifts the "
             "time offset. Move more slowly, or increase the camera's contrast thresholds",
             session_.stream, 100.0 * limit.share, 1e-6 * limit.rate_hz)});
  if (outside_ > 0) {
    faults.push_back(
        {session_.stream, FaultKind::OutsideResolution, 0.0,
         fmt::format("{}: {} outside {} x {} px {} excluded", session_.stream, counted(outside_, "event"),
                     resolution_px_.width_px, resolution_px_.height_px, outside_ == 1 ? "was" : "were")});
  }
}

void EventIntake::putInOrder(std::vector<Event>& events) {
  const auto earlier = [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; };
  if (!std::is_sorted(events.begin(), events.end(), earlier)) {
    for (std::size_t k = 1; k < events.size(); ++k) unsorted_ += events[k].time_ns < events[k - 1].time_ns;
    std::stable_sort(events.begin(), events.end(), earlier);
  }
  seen_ += events.size();
  outside_ += std::erase_if(events, [&](const Event& event) {
    return event.x_px >= resolution_px_.width_px || event.y_px >= resolution_px_.height_px;
  });
  late_ += std::erase_if(events, [&](const Event& event) { return event.time_ns < last_ns_; });
  // A few invalid coordinates indicate a damaged packet, many a wrong resolution.
  constexpr std::uint64_t kEnough = 1000;
  if (seen_ >= kEnough && 20 * outside_ > seen_) {
    throw badInput(session_.name,
                   fmt::format("resolution_px {} x {} is too small: {} of {} events are outside",
                               resolution_px_.width_px, resolution_px_.height_px, outside_, seen_),
                   "Give the resolution of the sensor, and intrinsics for it");
  }
}

}  // namespace evical
