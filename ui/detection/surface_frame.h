// SPDX-License-Identifier: GPL-3.0-or-later
// Picture of events or of a frame, with one point per sensor pixel, and the data for the pixel under the
// mouse. Pure functions of their inputs, for worker threads: the style contains the colours, since theme() is
// for the GUI thread.
#pragma once

#include "ui/detection/event_cache.h"

#include "core/data/event.h"
#include "core/geometry/resolution.h"

#include <QImage>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace evical {

struct NormalFlow;
}

namespace evical::ui {

enum class SurfaceMode {
  Decayed,      // newest event of each pixel, fading with age
  Accumulated,  // all events of the window, by number
  NormalFlow,   // edges of the window, coloured by their direction of motion
};

struct SurfaceStyle {
  SurfaceMode mode = SurfaceMode::Decayed;
  double decay_s = 0.015;  // an event has faded to 1/e
  QRgb background = 0xff000000, brighter = 0xffffffff, darker = 0xff8080ff;
  bool operator==(const SurfaceStyle&) const = default;
};
// Events older than this have faded.
inline double fadedAfter_s(const SurfaceStyle& style) {
  return 5.0 * style.decay_s;
}

// Position of a frame in its camera's sequence.
struct FrameLabel {
  std::size_t number = 0, count = 0;  // number from 1 on; count of the frames read until now
};

struct SurfaceFrame {
  static constexpr std::int32_t kNoEvent = std::numeric_limits<std::int32_t>::min();

  double time_s = 0.0;  // cursor or frame, since the recording's start
  QImage image;         // RGB32
  std::vector<std::int32_t>
      newest;  // by pixel: 2 * microseconds since the cursor, + 1 if brighter; or kNoEvent; empty for frames
  std::size_t events = 0;                    // drawn events
  std::optional<std::size_t> window_events;  // events in the window at the cursor
  std::optional<FrameLabel> photograph;      // for a frame

  Resolution resolution_px() const { return {image.width(), image.height()}; }

  struct Hit {
    double time_s;  // since the cursor
    bool brighter;
  };
  std::optional<Hit> newestAt(int x_px, int y_px) const;  // none also outside the sensor
};

// Events in any order, inside the resolution. time_ns is the cursor's.
SurfaceFrame renderEvents(EventSpan events, std::int64_t time_ns, Resolution resolution_px,
                          const SurfaceStyle& style);

QImage emptyImage(Resolution resolution_px, const SurfaceStyle& style);

// Paints frame.newest, which is relative to the cursor, into frame.image, which is empty.
void paintDecayed(const SurfaceStyle& style, SurfaceFrame& frame);

// Dimmed events with the flow on top: hue by direction, red to the right, clockwise.
SurfaceFrame renderFlow(EventSpan events, const std::vector<NormalFlow>& flow, std::int64_t time_ns,
                        Resolution resolution_px, const SurfaceStyle& style);

QRgb flowColour(double x, double y);  // colour of a direction

// Surface of active events at the cursor, kept between pictures: while the cursor advances, only the events
// since the last picture are read. Not thread-safe.
class DecayingSurface {
 public:
  // The unfaded events before time_ns, drawn like renderEvents().
  SurfaceFrame render(const std::shared_ptr<const EventCache>& cache, std::int64_t time_ns,
                      Resolution resolution_px, const SurfaceStyle& style);

 private:
  void add(std::int64_t begin_ns, std::int64_t end_ns);

  std::shared_ptr<const EventCache> cache_;
  Resolution resolution_px_;
  std::int64_t base_ns_ = 0;   // zero of the times in newest_
  std::int64_t begin_ns_ = 0;  // newest_ has all events of [begin_ns_, end_ns_)
  std::int64_t end_ns_ = 0;
  std::vector<std::int32_t> newest_;  // as in SurfaceFrame
  std::vector<Event> events_;
};

}  // namespace evical::ui
