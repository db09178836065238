// One pass over a recording without a board: how every event camera turns, and every IMU's samples in memory.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/recording.h"
#include "core/egomotion/camera_record.h"
#include "core/pipeline/session/session.h"

#include <cstdint>
#include <vector>

namespace evical {

struct BoardlessPass {
  std::int64_t start_ns = 0;          // first event or sample of the session's streams
  std::vector<CameraRecord> cameras;  // by camera of the session; empty of frames and points
  std::vector<CameraKind> kinds;
  std::vector<ImuData> imus;  // SI units, in time order
  std::vector<RecordingFault> faults;
};

// Through the session's lenses, of which all are known. Memory does not grow with the number of events. Throws BadInput
// for streams that are missing, empty, or do not fit the session, and Cancelled.
BoardlessPass readWithoutBoard(const Session& session, const RunContext& context);

}  // namespace evical
