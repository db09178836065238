// One pass over a recording: every camera's events through the front end, every IMU's samples into memory.
#pragma once

#include "core/base/progress.h"
#include "core/data/board_observations.h"
#include "core/data/calibration_setup.h"
#include "core/data/recording.h"
#include "core/pipeline/session/session.h"

#include <cstdint>
#include <vector>

namespace evical {

class BoardTracker;
class FrontEndObserver;

struct DetectionResult {
  std::int64_t start_ns = 0;  // first event or sample of the session's streams
  std::vector<BoardObservations> cameras;
  std::vector<CameraLens> lenses;  // by camera: what the observations were seen with
  std::vector<ImuData> imus;       // SI units, in time order
  std::vector<Resolution> resolutions_px;
  std::vector<RecordingFault> faults;
  double read_s = 0.0, detect_s = 0.0;  // the threads' own times, which overlap
  // By camera, in time order: what a person left out and may take back. Empty where nobody did.
  std::vector<std::vector<BoardView>> rejected_views = {};
};

// Reads and finds bursts in one thread, searches windows in another; memory does not grow with the number of
// events. Throws BadInput for streams that are missing, empty, or do not fit the session.
DetectionResult readAndDetect(const Session& session, const RunContext& context);

// The same through these lenses, one a camera, whatever the session gives.
DetectionResult readAndDetect(const Session& session, std::vector<CameraLens> lenses,
                              const RunContext& context);

// The IMUs alone, of a recording whose start is known: what cameras saw is not read.
DetectionResult readImus(const Session& session, std::int64_t start_ns, const RunContext& context);

}  // namespace evical
