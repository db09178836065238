// Which camera poses the gyroscope believes (docs/maths.md, 8.2): with the right mounting, every pose carried
// back to the first IMU sample gives the same rotation,
//   world_from_first = world_from_camera * camera_from_imu * first_from_imu(t)^-1,
// up to slow drift. The mirrored pose of a plane, and a board placed wrongly, give others.
#pragma once

#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/camera_poses.h"

#include <vector>

namespace evical {

struct PoseConsistency {
  int swapped = 0;         // to the plane's other pose
  int dropped = 0;         // neither pose fits
  double usual_rad = 0.0;  // median disagreement of those kept with their neighbours
};

// `gyro` with its bias removed. Keeps poses that agree with most of their neighbours within
// `largest_rotation_disagreement_rad`.
PoseConsistency keepConsistentPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                    const RelativeRotation& hand_eye, const InitialisationOptions& options);

}  // namespace evical
