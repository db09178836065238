// Check of an old calibration without a board: rotation and time offset of event cameras relative to the
// reference IMU, from the angular rates of both (docs/maths.md, 16).
#pragma once

#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/check/check_session.h"

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/recording.h"
#include "core/egomotion/camera_record.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/lens_rays.h"
#include "core/frontend/edge_crossings.h"
#include "core/frontend/edge_slopes.h"
#include "core/pipeline/session/calibration_options.h"
#include "core/pipeline/session/session.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace evical {

// One pass over a recording without a board: rotation of each event camera, and samples of each IMU.
struct BoardlessPass {
  std::int64_t start_ns = 0;          // first event or sample of the session's streams
  std::vector<CameraRecord> cameras;  // by camera of the session; empty for frames and points
  std::vector<CameraKind> kinds;
  std::vector<ImuData> imus;                   // SI units, in time order
  std::vector<double> imu_stamp_steps_s = {};  // as in DetectionResult
  std::vector<RecordingFault> faults;
};

// Uses the session's lenses, which must all be known. Memory does not grow with the number of events. Throws
// BadInput for streams that are missing, empty, or do not fit the session, and Cancelled.
BoardlessPass readWithoutBoard(const Session& session, const RunContext& context);

// Rotation of a camera over time from its events: bursts, slopes of their times, and the motion in each
// window.
class CameraMotion {
 public:
  // `start_ns`: start of the recording, the origin of the windows' times.
  CameraMotion(const CameraIntrinsics& lens, const CalibrationOptions& options, std::int64_t start_ns);

  // Adds bursts from BurstExtractor.
  void add(const std::vector<EdgeCrossing>& bursts, std::int64_t complete_until_ns) {
    slopes_.add(bursts, complete_until_ns);
  }
  CameraRecord finish();

 private:
  LensRays lens_;
  EgomotionOptions options_;
  std::int64_t start_ns_;
  CameraRecord record_;
  EdgeSlopeFinder slopes_;
};

// Reads the recording. An uninformative recording gives a verdict, not an error. Throws as checkCalibration.
CheckRun checkWithoutBoard(const CheckInput& input, const RunContext& context);

// The same from data that were read before.
CheckRun checkWithoutBoard(const CheckInput& input, BoardlessPass pass, const RunContext& context = {});

}  // namespace evical
