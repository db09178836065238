// Conditions before and between the steps of initialisation; each throws CalibrationError with problem, place
// and advice.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialisation_options.h"

#include <string>
#include <vector>

namespace evical {

// The board, cameras with intrinsics, and IMUs with samples or a second camera are present.
void checkInput(const CalibrationInput& input, const InitialisationOptions& options);
// An IMU that is at rest while a camera turns is not on the rig, or its samples are from another recording.
void checkTurnsWithCamera(const CalibrationInput& input, const ImuData& imu, const GyroRotation& gyro,
                          const InitialisationOptions& options, const RunContext& context);
// The gyroscope moves. Warns of gaps.
void checkGyroscope(const ImuData& imu, const GyroRotation& gyro, const InitialisationOptions& options,
                    std::vector<std::string>& warnings);
// There are enough poses.
void checkViews(const CameraData& camera, const CameraPoses& found, const InitialisationOptions& options);
// Poses overlap with the IMU. Call it once the offset is known.
void checkOverlap(const ImuData& imu, double views_begin_s, double views_end_s, double begin_s, double end_s,
                  const InitialisationOptions& options);

}  // namespace evical
