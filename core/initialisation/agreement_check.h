// Camera, gyroscope and accelerometer must measure the same motion. If they do not, possible causes are
// tried, and CalibrationFailed is thrown with the most probable one: a result would have large errors.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/initialise.h"

namespace evical {

// No batches of samples that are stamped alike, and no axis that never changes.
void checkStampsApart(const ImuData& imu);
void checkAxesAlive(const ImuData& imu);

void checkRotationsAgree(const CalibrationInput& input, const CameraAgreement& agreement,
                         const InitialisationOptions& options, const RunContext& context);

// Fails only where the accelerometer's axes, read another way, agree far better.
void checkAccelerationsAgree(const CalibrationInput& input, const GravityAlignment& gravity,
                             const InitialisationOptions& options, const RunContext& context);

}  // namespace evical
