// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/surface_frame.h"

#include "core/base/time.h"
#include "core/frontend/normal_flow.h"

#include <QColor>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace evical::ui {
namespace {

constexpr std::int64_t kLongestAge_us = 1'000'000'000;

QRgb mix(QRgb from, QRgb to, double part) {
  const auto channel = [part](int a, int b) { return static_cast<int>(std::lround(a + part * (b - a))); };
  return qRgb(channel(qRed(from), qRed(to)), channel(qGreen(from), qGreen(to)),
              channel(qBlue(from), qBlue(to)));
}

SurfaceFrame emptyFrame(Resolution resolution_px, const SurfaceStyle& style) {
  SurfaceFrame frame;
  frame.image = emptyImage(resolution_px, style);
  frame.newest.assign(static_cast<std::size_t>(resolution_px.pixelCount()), SurfaceFrame::kNoEvent);
  return frame;
}

void noteNewest(EventSpan events, std::int64_t time_ns, SurfaceFrame& frame) {
  const auto width = static_cast<std::size_t>(frame.image.width());
  for (const Event& event : events) {
    const std::int64_t after_us = (event.time_ns - time_ns) / 1000;
    if (after_us < -kLongestAge_us || after_us > kLongestAge_us) continue;
    const auto packed = static_cast<std::int32_t>(2 * after_us + (event.brighter ? 1 : 0));
    std::int32_t& newest = frame.newest[event.y_px * width + event.x_px];
    newest = std::max(newest, packed);
  }
  frame.events = events.size();
}

// Colour: polarity of a pixel; strength: its number of events relative to the usual number.
void paintAccumulated(EventSpan events, const SurfaceStyle& style, double strength, SurfaceFrame& frame) {
  const auto width = static_cast<std::size_t>(frame.image.width());
  std::vector<std::array<std::uint16_t, 2>> counts(frame.newest.size(), {0, 0});
  std::size_t active = 0;
  for (const Event& event : events) {
    auto& pixel = counts[event.y_px * width + event.x_px];
    active += pixel[0] + pixel[1] == 0;
    std::uint16_t& count = pixel[event.brighter];
    if (count < std::numeric_limits<std::uint16_t>::max()) ++count;
  }
  if (active == 0) return;
  const double usual = 1.5 * static_cast<double>(events.size()) / static_cast<double>(active);
  for (int y = 0; y < frame.image.height(); ++y) {
    auto* row = reinterpret_cast<QRgb*>(frame.image.scanLine(y));
    for (int x = 0; x < frame.image.width(); ++x) {
      const auto& [darker, brighter] =
          counts[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
      const int sum = darker + brighter;
      if (sum == 0) continue;
      const QRgb colour = mix(style.darker, style.brighter, static_cast<double>(brighter) / sum);
      row[x] = mix(style.background, colour, strength * std::min(1.0, 0.25 + 0.75 * sum / usual));
    }
  }
}

}  // namespace

QImage emptyImage(Resolution resolution_px, const SurfaceStyle& style) {
  QImage image(resolution_px.width_px, resolution_px.height_px, QImage::Format_RGB32);
  image.fill(style.background);
  return image;
}

void paintDecayed(const SurfaceStyle& style, SurfaceFrame& frame) {
  constexpr int kSteps = 512;
  std::array<std::array<QRgb, kSteps>, 2> colours;
  for (int k = 0; k < kSteps; ++k) {
    const double part = std::exp(-k * fadedAfter_s(style) / (kSteps * style.decay_s));
    colours[0][static_cast<std::size_t>(k)] = mix(style.background, style.darker, part);
    colours[1][static_cast<std::size_t>(k)] = mix(style.background, style.brighter, part);
  }
  const float steps_per_half_us = static_cast<float>(kSteps / (2e6 * fadedAfter_s(style)));
  const std::int32_t* newest = frame.newest.data();
  for (int y = 0; y < frame.image.height(); ++y) {
    auto* row = reinterpret_cast<QRgb*>(frame.image.scanLine(y));
    for (int x = 0; x < frame.image.width(); ++x, ++newest) {
      if (*newest == SurfaceFrame::kNoEvent) continue;
      const float step = steps_per_half_us * static_cast<float>(-(*newest & ~1));
      if (step >= kSteps) continue;
      row[x] = colours[static_cast<std::size_t>(*newest & 1)][static_cast<std::size_t>(std::max(step, 0.0f))];
    }
  }
}

std::optional<SurfaceFrame::Hit> SurfaceFrame::newestAt(int x_px, int y_px) const {
  if (x_px < 0 || y_px < 0 || x_px >= image.width() || y_px >= image.height() || newest.empty())
    return std::nullopt;
  const std::int32_t packed =
      newest[static_cast<std::size_t>(y_px) * static_cast<std::size_t>(image.width()) +
             static_cast<std::size_t>(x_px)];
  if (packed == kNoEvent) return std::nullopt;
  return Hit{0.5e-6 * (packed & ~1), (packed & 1) != 0};
}

SurfaceFrame renderEvents(EventSpan events, std::int64_t time_ns, Resolution resolution_px,
                          const SurfaceStyle& style) {
  SurfaceFrame frame = emptyFrame(resolution_px, style);
  noteNewest(events, time_ns, frame);
  if (style.mode == SurfaceMode::Decayed) {
    paintDecayed(style, frame);
  } else {
    paintAccumulated(events, style, 1.0, frame);
  }
  return frame;
}

SurfaceFrame renderFlow(EventSpan events, const std::vector<NormalFlow>& flow, std::int64_t time_ns,
                        Resolution resolution_px, const SurfaceStyle& style) {
  constexpr double kFaint = 0.3;
  SurfaceFrame frame = emptyFrame(resolution_px, style);
  noteNewest(events, time_ns, frame);
  paintAccumulated(events, style, kFaint, frame);
  for (const NormalFlow& edge : flow) {
    frame.image.setPixel(
        edge.x_px, edge.y_px,
        flowColour(static_cast<double>(edge.velocity_px_s.x()), static_cast<double>(edge.velocity_px_s.y())));
  }
  return frame;
}

QRgb flowColour(double x, double y) {
  const double turn = std::atan2(y, x) / (2.0 * std::numbers::pi);
  return QColor::fromHsvF(static_cast<float>(turn < 0.0 ? turn + 1.0 : turn), 0.85f, 0.95f).rgb();
}

}  // namespace evical::ui

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
