// Whether camera and gyroscope can be parts of one rigid, right-handed rig: what is left of the gyroscope's
// rotation once the best rotation of the camera's is taken off, and once the best reflection of it is.
#pragma once

#include "core/initialisation/camera_imu_rotation.h"

#include <vector>

namespace evical {

// Of rotations between neighbouring views. Shares are of what the gyroscope turned: medians of |rest| over the
// median of |turned|, without means, which a bias may be.
struct RotationAgreement {
  double rotated = 0.0, reflected = 0.0;
  double rest_rad = 0.0;  // what the best rotation leaves, by itself
  int pairs = 0;          // 0: none overlap, and the rest says nothing
};
RotationAgreement compareRotations(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                   double time_offset_s, const InitialisationOptions& options);

}  // namespace evical
