// Test whether camera and gyroscope can be parts of one rigid, right-handed rig: the residual of the
// gyroscope's rotation after the best rotation of the camera's, and after its best reflection.
#pragma once

#include "core/initialisation/camera_imu_rotation.h"

#include <vector>

namespace evical {

// Agreement of rotations between neighbouring views. Shares are relative to the gyroscope's rotation: median
// of |residual| over median of |rotation|, without means, which may be biases.
struct RotationAgreement {
  double rotated = 0.0, reflected = 0.0;
  double rest_rad = 0.0;  // residual of the best rotation
  int pairs = 0;          // 0: none overlap, and the other values are meaningless
};
RotationAgreement compareRotations(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                   double time_offset_s, const InitialisationOptions& options);

}  // namespace evical
