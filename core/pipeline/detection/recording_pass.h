// One pass over a recording: events of all cameras are processed by the front end, IMU samples are stored.
#pragma once

#include "core/base/progress.h"
#include "core/data/board_observations.h"
#include "core/data/calibration_setup.h"
#include "core/data/recording.h"
#include "core/initialisation/mirror_check.h"
#include "core/pipeline/session/session.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace evical {

class BoardTracker;
class FrontEndObserver;
class Growth;

struct [[nodiscard]] DetectionResult {
  std::int64_t start_ns = 0;  // first event or sample of the session's streams
  std::vector<BoardObservations> cameras;
  std::vector<CameraLens> lenses;  // by camera: used for the observations
  std::vector<ImuData> imus;       // SI units, in time order
  std::vector<Resolution> resolutions_px;
  std::vector<RecordingFault> faults;
  double read_s = 0.0, detect_s = 0.0;  // times of the threads, which overlap
  // By camera, in time order: views that were rejected by hand and can be restored. Empty if none were.
  std::vector<std::vector<BoardView>> rejected_views = {};
  // By IMU: step of coarse stamps, of which half a step is added to the sigmas of time offsets; 0: not
  // coarse. Empty if all are 0.
  std::vector<double> imu_stamp_steps_s = {};
};

// Reads and extracts bursts in one thread, searches windows in another. Memory does not grow with the number
// of events. Throws BadInput for streams that are missing, empty, or do not fit the session.
DetectionResult readAndDetect(const Session& session, const RunContext& context);

// A recording that is still being written.
struct LivePass {
  std::shared_ptr<Growth> growth;  // of the session's only file
  // Called by the reading thread after a while: IMU samples so far, not in order yet.
  std::function<void(const DetectionResult& so_far)> samplesRead;
};

// The same with these lenses, one per camera, instead of the session's. `live`: waits for the recording's
// end.
DetectionResult readAndDetect(const Session& session, std::vector<CameraLens> lenses,
                              const RunContext& context, const LivePass* live = nullptr);

// Reads only the IMUs of a recording with a known start; data of cameras are not read.
DetectionResult readImus(const Session& session, std::int64_t start_ns, const RunContext& context);

// Input of initialisation and batch from a pass.

// Combines the data with the session's sensors. Moves the data of cameras and IMUs out of the pass: in long
// recordings they are most of the memory.
CalibrationInput makeInput(const Session& session, DetectionResult& detections);

// Statements of the session about mirrored images and signs of accelerations.
StatedSigns statedSigns(const Session& session);

// Moves the data back; an empty input has no effect.
void restorePass(CalibrationInput input, DetectionResult& detections);

}  // namespace evical
