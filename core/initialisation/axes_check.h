// Detection of wrong axes of an IMU, if camera, gyroscope and accelerometer cannot be parts of one
// right-handed rig. All 48 permutations and signs of the accelerometer's axes are tested, and the one with
// which accelerations agree with positions is reported.
#pragma once

#include "core/base/progress.h"
#include "core/base/repair.h"
#include "core/data/calibration_setup.h"
#include "core/initialisation/initialisation_options.h"

#include <optional>
#include <string>

namespace evical {

struct AxesCause {
  std::string problem, advice;
  bool negated = false;  // only the sign of accelerations is wrong, as for a mirrored image (mirror_check.h)
  std::optional<Repair> repair = {};  // if only one sensor's axes are wrong
};
// `left_handed_gyroscope`: the gyroscope's rotation is a reflection of the camera's. Empty if no reading is
// far better.
std::optional<AxesCause> findWrongAxes(const CalibrationInput& input, bool left_handed_gyroscope,
                                       const InitialisationOptions& options, const RunContext& context);

}  // namespace evical
