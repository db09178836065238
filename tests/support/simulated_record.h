// The record of a camera in a check without a board, from a scenario's simulated events.
#pragma once

#include "core/egomotion/camera_record.h"
#include "core/pipeline/session/calibration_options.h"
#include "core/synthetic/scenario.h"

namespace evical::test {

struct SimulatedRecord {
  CameraRecord record;
  double processor_s = 0.0;  // of this thread, without the simulation
};

// The record of its first camera.
SimulatedRecord simulatedRecord(const Scenario& scenario, const CalibrationOptions& options);

}  // namespace evical::test
