// SPDX-License-Identifier: GPL-3.0-or-later
// Events or a frame as a picture with one point a sensor pixel, and what hovering over it tells. Pure functions of their
// inputs, for worker threads: colours come with the style, since theme() belongs to the GUI thread.
#pragma once

#include "core/data/event.h"

#include "core/geometry/resolution.h"

#include <QImage>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace evical {
struct NormalFlow;
}

namespace evical::ui {

enum class SurfaceMode {
  Decayed,      // newest event of each pixel, fading with its age
  Accumulated,  // all events of the window, by number
  NormalFlow,   // edges of the window, coloured by the direction they move in
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

// Which frame of a camera it is.
struct FrameLabel {
  std::size_t number = 0, count = 0;  // from 1 on; of the frames read so far
};

struct SurfaceFrame {
  static constexpr std::int32_t kNoEvent = std::numeric_limits<std::int32_t>::min();

  double time_s = 0.0;  // of the cursor, or of the frame, since the recording's start
  QImage image;         // RGB32
  std::vector<std::int32_t>
      newest;  // by pixel: 2 * microseconds since the cursor, + 1 if brighter; or kNoEvent; empty of frames
  std::size_t events = 0;                    // that are drawn
  std::optional<std::size_t> window_events;  // that the window at the cursor has
  std::optional<FrameLabel> photograph;      // where this is a frame

  Resolution resolution_px() const { return {image.width(), image.height()}; }

  struct Hit {
    double time_s;  // since the cursor
    bool brighter;
  };
  std::optional<Hit> newestAt(int x_px, int y_px) const;  // nothing outside, too
};

// Events in any order, inside the resolution. time_ns is the cursor's.
SurfaceFrame renderEvents(EventSpan events, std::int64_t time_ns, Resolution resolution_px,
                          const SurfaceStyle& style);

QImage emptyImage(Resolution resolution_px, const SurfaceStyle& style);

// Paints frame.newest, which is relative to the cursor, into frame.image, which is empty.
void paintDecayed(const SurfaceStyle& style, SurfaceFrame& frame);

// The same events faintly, and over them the flow: hue by direction, red to the right, turning as on a clock.
SurfaceFrame renderFlow(EventSpan events, const std::vector<NormalFlow>& flow, std::int64_t time_ns,
                        Resolution resolution_px, const SurfaceStyle& style);

QRgb flowColour(double x, double y);  // of a direction

}  // namespace evical::ui
