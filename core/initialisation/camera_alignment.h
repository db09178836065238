// Alignment of one camera with the reference IMU's gyroscope: its poses, time offset and rotation
// (docs/maths.md, 8.2 to 8.4).
#pragma once

#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/world_rotation.h"

#include <vector>

namespace evical {

// Adds steps and warnings to `result`. Throws CalibrationFailed with advice.
AlignedCamera alignCamera(const CameraData& camera, const CalibrationInput& input, const GyroRotation& gyro,
                          const InitialisationOptions& options, const RunContext& context,
                          Initialisation& result);

// Consistency of camera poses with the gyroscope (docs/maths.md, 8.2): with the correct mounting, every pose
// transformed to the first IMU sample gives the same rotation,
//   world_from_first = world_from_camera * camera_from_imu * first_from_imu(t)^-1,
// up to slow drift. The mirrored pose of a plane, and a misidentified board, give others.
struct PoseConsistency {
  int swapped = 0;         // to the plane's other pose
  int dropped = 0;         // neither pose fits
  double usual_rad = 0.0;  // median disagreement of kept poses with their neighbours
};

// `gyro` without its bias. Keeps poses that agree with enough of their neighbours within
// `max_rotation_disagreement_rad`.
PoseConsistency keepConsistentPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                    const RelativeRotation& hand_eye, const InitialisationOptions& options);

}  // namespace evical
