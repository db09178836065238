// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a session's recording once, into caches of a camera's events or frames and two curves. Other threads
// can use the part that has been read; the whole takes one pass over the file.
//
// In a rig with both kinds of cameras, one of the other kind is also read, to be shown next to this one: the
// one with the same sensor, else the first.
#pragma once

#include "ui/detection/event_cache.h"
#include "ui/detection/frame_cache.h"

#include "core/data/board_observations.h"
#include "core/pipeline/session/session.h"
#include "ui/jobs/live_view.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

// A quantity over time in bins of the same length.

namespace evical::ui {

struct RateCurve {
  double begin_s = 0.0, step_s = 0.01;
  std::vector<float> values;  // NaN if unknown

  double end_s() const { return begin_s + step_s * static_cast<double>(values.size()); }
  // Index of the bin that contains a time; values.size() if none does.
  std::size_t binAt(double time_s) const {
    const double bin = std::floor((time_s - begin_s) / step_s);
    return bin >= 0.0 && bin < static_cast<double>(values.size()) ? static_cast<std::size_t>(bin)
                                                                  : values.size();
  }
};

struct RecordingOverview {
  bool started = false;       // start_ns and resolution_px are known
  std::int64_t start_ns = 0;  // zero of a calibration: first event or sample of the session's streams
  CameraKind kind = CameraKind::Events;
  std::optional<std::size_t> companion;  // the camera of the other kind
  Resolution resolution_px;              // may be unknown for frames, which contain it
  double read_until_s = 0.0;             // of the camera's events or frames
  double fraction_read = 0.0;
  bool finished = false;
  std::string error;        // empty: none; data before the error stay available
  RateCurve event_rate;     // events/s; for a frame camera those of the companion
  RateCurve rotation_rate;  // rad/s, of the reference IMU
};

// Caches of the camera and its companion; null if there is none of a kind.
struct RecordingCaches {
  std::shared_ptr<const EventCache> events;
  std::shared_ptr<const FrameCache> frames;
  Resolution events_px;
};

class EventWindowReader {
 public:
  // `changed` is called from the reading thread, at most ten times a second, and not again before overview()
  // was called. `folder` is for the cache.
  EventWindowReader(const Session& session, std::size_t camera, const std::filesystem::path& folder,
                    std::function<void()> changed);

  // Call once; reads to the end or until stopped. Errors are in the overview.
  void read(const std::stop_token& stop);

  // Thread-safe during read().
  RecordingOverview overview() const;
  RecordingCaches caches() const;  // none before `started`
  std::shared_ptr<const EventCache> cache() const { return caches().events; }

 private:
  class CacheFilling;
  class Pass;
  struct State {
    RecordingOverview overview;
    RecordingCaches caches;
  };
  void readAll(const std::stop_token& stop);
  void publish();

  Session session_;
  std::size_t camera_;
  std::filesystem::path folder_;
  State state_;  // the reading thread's
  mutable Mailbox<State> published_;
};

}  // namespace evical::ui
