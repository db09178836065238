// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a session's recording once into caches of a camera's events or frames and two curves. What has been read can
// be looked at from another thread while the rest still comes; the whole takes as long as one pass over the file.
//
// Of a rig with both kinds of camera the other one is read along, to be shown beside this one: the one of the same
// sensor, or else the first.
#pragma once

#include "core/data/board_observations.h"
#include "core/pipeline/session/session.h"
#include "ui/detection/event_cache.h"
#include "ui/detection/frame_cache.h"
#include "ui/detection/rate_curve.h"
#include "ui/jobs/mailbox.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

namespace evical::ui {

struct RecordingOverview {
  bool started = false;       // start_ns and resolution_px are known
  std::int64_t start_ns = 0;  // as the calibration has it: the first event or sample of the session's streams
  CameraKind kind = CameraKind::Events;
  std::optional<std::size_t> companion;  // the camera of the other kind
  Resolution resolution_px;              // of frames perhaps unknown: they tell it themselves
  double read_until_s = 0.0;             // of the camera's events or frames
  double fraction_read = 0.0;
  bool finished = false;
  std::string error;        // empty: none; what was read before it can still be looked at
  RateCurve event_rate;     // events/s, the companion's of a camera with frames
  RateCurve rotation_rate;  // rad/s, of the reference IMU
};

// The camera's and its companion's; null where there is none of a kind.
struct RecordingCaches {
  std::shared_ptr<const EventCache> events;
  std::shared_ptr<const FrameCache> frames;
  Resolution events_px;
};

class EventWindowReader {
 public:
  // `changed` is called from the thread that reads, ten times a second at most, and not again before the
  // overview was looked at. `folder` is for the cache.
  EventWindowReader(const Session& session, std::size_t camera, const std::filesystem::path& folder,
                    std::function<void()> changed);

  // Once, to the end or until it is told to stop; what goes wrong is in the overview.
  void read(const std::stop_token& stop);

  // From another thread, also while it reads.
  RecordingOverview overview() const;
  RecordingCaches caches() const;  // none before started
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
