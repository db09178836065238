// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/decaying_surface.h"

#include "core/base/time.h"

#include <algorithm>

namespace evical::ui {
namespace {

constexpr std::int64_t kLongestFromBase_ns = 500'000'000'000;  // 2 * microseconds stay far within 32 bits

}  // namespace

SurfaceFrame DecayingSurface::render(const std::shared_ptr<const EventCache>& cache, std::int64_t time_ns,
                                     Resolution resolution_px, const SurfaceStyle& style) {
  const std::int64_t faded_ns = time_ns - nanosecondsFrom(fadedAfter_s(style));
  const bool goes_on = cache == cache_ && resolution_px == resolution_px_ && begin_ns_ <= faded_ns &&
                       faded_ns <= end_ns_ && end_ns_ <= time_ns && time_ns - base_ns_ < kLongestFromBase_ns;
  if (!goes_on) {
    cache_ = cache;
    resolution_px_ = resolution_px;
    newest_.assign(static_cast<std::size_t>(resolution_px.pixelCount()), SurfaceFrame::kNoEvent);
    base_ns_ = begin_ns_ = end_ns_ = faded_ns;
  }
  add(end_ns_, time_ns);

  SurfaceFrame frame;
  frame.image = emptyImage(resolution_px, style);
  frame.events = cache->count(faded_ns, time_ns);
  frame.newest.resize(newest_.size());
  const auto now = static_cast<std::int32_t>(2 * ((time_ns - base_ns_) / 1000));
  const auto faded = static_cast<std::int32_t>(2 * ((faded_ns - base_ns_) / 1000));
  std::transform(newest_.begin(), newest_.end(), frame.newest.begin(),
                 [=](std::int32_t newest) { return newest < faded ? SurfaceFrame::kNoEvent : newest - now; });
  paintDecayed(style, frame);
  return frame;
}

void DecayingSurface::add(std::int64_t begin_ns, std::int64_t end_ns) {
  // Events that are not yet written may still come.
  end_ns_ = std::max(begin_ns, std::min(end_ns, cache_->completeUntil_ns()));
  events_.clear();
  cache_->gather(begin_ns, end_ns_, events_);
  const auto width = static_cast<std::size_t>(resolution_px_.width_px);
  for (const Event& event : events_) {
    const auto after_us = (event.time_ns - base_ns_) / 1000;
    newest_[event.y_px * width + event.x_px] =
        static_cast<std::int32_t>(2 * after_us + (event.brighter ? 1 : 0));
  }
}

}  // namespace evical::ui
