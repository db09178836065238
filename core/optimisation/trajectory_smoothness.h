// Acceleration of a trajectory without an IMU, determined from its views: the expected acceleration
// between them.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

namespace evical {

// RMS of each axis' acceleration over the control points that views determine; infinite without any.
struct TrajectorySmoothness {
  double rotation_rad_s2 = 0.0, position_m_s2 = 0.0;
};
TrajectorySmoothness trajectorySmoothness(const CalibrationInput& input, const CalibrationState& state);

}  // namespace evical
