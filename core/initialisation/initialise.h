// Initial state for the batch from board views and IMU samples, from which the batch converges
// (docs/maths.md, 8).
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/mirror_check.h"
#include "core/initialisation/rotation_agreement.h"
#include "core/initialisation/time_offset.h"

#include <array>
#include <string>
#include <vector>

namespace evical {

// Steps of every rig with an IMU, in their order; some rigs have further ones.
enum class UsualStep { CameraPoses, PlanarPoses, TimeOffset, CameraImuRotation, GravityAndTranslation };
inline constexpr std::array kUsualSteps = {"camera poses", "planar poses", "time offset",
                                           "camera-IMU rotation", "gravity and translation"};
constexpr const char* nameOf(UsualStep step) {
  return kUsualSteps[static_cast<std::size_t>(step)];
}

struct InitialisationStep {
  std::string name;
  std::string subject;  // its sensor or board; empty: all of them
  std::string result;   // its main figures as text
  double residual = 0.0;
  double condition = 0.0;   // 0: not applicable
  double duration_s = 0.0;  // computing time

  std::string text() const { return subject.empty() ? result : subject + ": " + result; }
};

// Agreement of one camera's rotations with the reference IMU's, at the estimated time offset.
struct CameraAgreement {
  std::string camera;
  double correlation = 1.0;  // of rates
  RotationAgreement rotation;
  std::optional<ClockStep> clock_step;
};

struct Initialisation {
  CalibrationState state;
  std::vector<InitialisationStep> steps;
  std::vector<CameraAgreement> agreements;  // empty without an IMU
  std::vector<std::string> warnings;
  std::string doubt;              // about the board's size; may be empty
  std::string mirror_doubt;       // about a mirrored image; may be empty
  bool forces_show_size = false;  // accelerations determine the board's size significantly, with its sign
  double board_scale =
      1.0;  // according to accelerations: the board's size in units of the given one, if in doubt
};

// Any number of cameras and IMUs relative to the reference: an IMU, or a camera if there is no IMU. Throws
// CalibrationFailed with the reason: too few views, too short, no overlap in time, no motion.
Initialisation initialise(const CalibrationInput& input, const InitialisationOptions& options,
                          const RunContext& context, const StatedSigns& stated = {});

}  // namespace evical
