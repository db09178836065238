// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a session's recording once, in a thread of its own, into an event cache and two curves. What has been
// read can be looked at while the rest still comes; the whole takes as long as one pass over the file.
#pragma once

#include "core/pipeline/session.h"
#include "ui/detection/event_cache.h"
#include "ui/detection/rate_curve.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace evical::ui {

struct RecordingOverview {
  bool started = false;       // start_ns and resolution_px are known
  std::int64_t start_ns = 0;  // as the calibration has it: the first event or sample of the session's streams
  Resolution resolution_px;
  double read_until_s = 0.0;  // of the camera's events
  double fraction_read = 0.0;
  bool finished = false;
  std::string error;        // empty: none; what was read before it can still be looked at
  RateCurve event_rate;     // events/s
  RateCurve rotation_rate;  // rad/s, of the reference IMU
};

class EventWindowReader {
 public:
  // `changed` is called from the thread, ten times a second at most. `folder` is for the cache.
  EventWindowReader(const Session& session, std::size_t camera, const std::filesystem::path& folder,
                    std::function<void()> changed);

  // Ends soon after this, but waits for nobody; the destructor does.
  void stop() { thread_.request_stop(); }
  bool ended() const { return ended_; }

  RecordingOverview overview() const;
  // Null before started.
  std::shared_ptr<const EventCache> cache() const;

 private:
  class Pass;
  void run(const std::stop_token& stop);
  void readAll(const std::stop_token& stop);
  void publish(const Pass& pass, double fraction, bool finished);

  Session session_;
  std::size_t camera_;
  std::filesystem::path folder_;
  std::function<void()> changed_;
  std::atomic<bool> ended_ = false;
  mutable std::mutex mutex_;
  RecordingOverview overview_;
  std::shared_ptr<EventCache> cache_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace evical::ui
