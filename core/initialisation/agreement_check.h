// Checks that camera, gyroscope and accelerometer measure the same motion. If they do not, possible causes
// are tested, and CalibrationFailed is thrown with the most probable one: a result would have large errors.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/mirror_check.h"

#include <span>

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

}  // namespace evical
