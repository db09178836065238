// Records live streams into one file. What has arrived is on the disk within 0.1 s, and the file can be read
// while it is written, also by another program, and after this one was killed.
#pragma once

#include "core/base/progress.h"
#include "core/data/recording.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace evical {

struct LiveRequest {
  std::vector<std::string> sources;  // as in openLive()
  std::filesystem::path output;
  std::string format;        // of recordingFormats(), if it is live; empty: by the output's extension
  Resolution resolution_px;  // of event streams, if the source does not state it
  double max_duration_s = std::numeric_limits<double>::infinity();  // of the recording's own times
  // Called when the file can be read and has grown, with its duration.
  std::function<void(double recorded_s)> progressed = {};
};

struct LiveSummary {
  std::string format;
  std::vector<StreamInfo> streams;  // written
  std::uint64_t events = 0, imu_samples = 0, frames = 0;
  double duration_s = 0.0;
  std::vector<RecordingFault> faults;
};

// Until all sources have ended, the duration is reached, or a stop is requested: this ends the recording
// properly. Throws CalibrationError, and Cancelled if it is stopped before any data. An existing file is
// replaced when the first data have arrived; after an error what was recorded remains.
LiveSummary recordLive(const LiveRequest& request, const RunContext& context);

}  // namespace evical
