// Checks that camera, gyroscope and accelerometer measure the same motion. If they do not, possible causes
// are tested, and CalibrationFailed is thrown with the most probable one: a result would have large errors.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/mirror_check.h"

#include <optional>
#include <span>
#include <string>

namespace evical {

// An axis that never changes; null if there is none.
const ImuAxis* deadAxis(const ImuData& imu);

// Rejects batches of samples with stamps of their arrival, and axes that never change.
void checkStampsApart(const ImuData& imu);
void checkAxesAlive(const ImuData& imu);

void checkRotationsAgree(const CalibrationInput& input, const CameraAgreement& agreement,
                         const InitialisationOptions& options, const RunContext& context);

// Fails only if another reading of the accelerometer's axes agrees far better, or if accelerations have the
// opposite sign. `gyro` without its bias.
void checkAccelerationsAgree(const CalibrationInput& input, const StatedSigns& stated,
                             std::span<const AlignedCamera> cameras, const GyroRotation& gyro,
                             const GravityAlignment& gravity, const InitialisationOptions& options,
                             const RunContext& context);

// Detection of wrong axes of an IMU, if camera, gyroscope and accelerometer cannot be parts of one
// right-handed rig. All 48 permutations and signs of the accelerometer's axes are tested, and the one with
// which accelerations agree with positions is reported.
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
