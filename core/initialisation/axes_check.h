// Wrong axes of an IMU, if camera, gyroscope and accelerometer cannot be parts of one right-handed rig. Every
// permutation and sign of the accelerometer's axes is tried (48), and the one under which accelerations agree
// with positions is reported.
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
  std::optional<Repair> repair = {};  // where one sensor alone is read wrongly
};
// `left_handed_gyroscope`: only a reflection of the camera's rotation is the gyroscope's. Nothing where no reading
// is better by far.
std::optional<AxesCause> findWrongAxes(const CalibrationInput& input, bool left_handed_gyroscope,
                                       const InitialisationOptions& options, const RunContext& context);

}  // namespace evical
