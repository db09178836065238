// From board views and IMU samples to a state from which the batch converges (docs/maths.md, 8).
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/piecewise_time_offset.h"
#include "core/initialisation/rotation_agreement.h"

#include <string>
#include <vector>

namespace evical {

struct InitialisationStep {
  std::string name;     // "camera poses", "time offset", ...
  std::string subject;  // the sensor or board that it is of; empty: all of them
  std::string result;   // its key number, in words
  double residual = 0.0;
  double condition = 0.0;   // 0 where it has none
  double duration_s = 0.0;  // of the work

  std::string text() const { return subject.empty() ? result : subject + ": " + result; }
};

// Of one camera's rotations with the reference IMU's, at the time offset that was found.
struct CameraAgreement {
  std::string camera;
  double correlation = 1.0;  // of rates
  RotationAgreement rotation;
  std::optional<ClockStep> clock_step;
};

struct Initialisation {
  CalibrationState state;
  std::vector<InitialisationStep> steps;
  std::vector<CameraAgreement> agreements;  // none where there is no IMU
  std::vector<std::string> warnings;
  std::string doubt;  // what makes any result doubtful; empty if nothing does
};

// Any number of cameras and IMUs against the reference: an IMU, or a camera where there is no IMU. Throws
// CalibrationFailed with a reason in plain words: too few views, too short, no overlap in time, no motion.
Initialisation initialise(const CalibrationInput& input, const InitialisationOptions& options,
                          const RunContext& context);

}  // namespace evical
