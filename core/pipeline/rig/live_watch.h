// Records live streams and detects and assesses them meanwhile: says what is missing, and ends the recording
// when it is good enough.
#pragma once

#include "core/pipeline/rig/recording_assessment.h"

#include "core/base/progress.h"
#include "core/pipeline/rig/detected_recording.h"
#include "core/pipeline/session/session.h"
#include "core/recording/live/live_recording.h"

#include <optional>
#include <string>

namespace evical {

struct LiveState {
  double recorded_s = 0.0;
  double behind_s = 0.0;  // of the detection
  RecordingAssessment assessment;
  std::string instruction;             // what to do now, the most important first; empty: go on
  std::optional<double> until_good_s;  // at this pace; absent: unknown
};

// Called from one thread, one call at a time.
class LiveWatcher {
 public:
  virtual ~LiveWatcher() = default;
  virtual void assessed(const LiveState& state) = 0;
};

struct WatchRequest {
  LiveRequest record;
  Session session;  // of the rig; its recording is the file that is written
  bool until_good = true;
};

struct [[nodiscard]] WatchedRecording {
  LiveSummary recorded;
  Session session;  // of the new file
  DetectedRecording detected;
  bool is_good = false;
};

// Ends as recordLive() does, or when the recording is good enough. What was recorded remains after any error.
// All lenses must be given. Throws CalibrationError, and Cancelled if it is stopped before any data.
WatchedRecording watchLive(const WatchRequest& request, LiveWatcher& watcher, const RunContext& context);

// The first thing to do about a recording so far; empty if it is too early to say. `until_good_s`: as in
// LiveState.
std::string instructionFor(const RecordingAssessment& assessment, double recorded_s,
                           std::optional<double> until_good_s);

}  // namespace evical
