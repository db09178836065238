// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/trajectory_pose.h"

#include "core/geometry/trajectory.h"

namespace evical::ui {

std::optional<RigidTransform> cameraFromWorldAt(const CalibrationState& state, const CameraState& camera,
                                                double camera_time_s) {
  const double imu_time_s = referenceTime_s(camera, camera_time_s);
  if (state.world_from_imu_rotation.segmentCount() < 1 || !state.world_from_imu_rotation.contains(imu_time_s))
    return std::nullopt;
  return cameraFromWorld(state.world_from_imu_rotation, state.imu_in_world_m, camera.reference_from_camera,
                         timeOffsetAt_s(camera, camera_time_s), camera_time_s);
}

double rowTime_s(const CameraState& camera, double frame_time_s, double y_px) {
  const double middle_px = 0.5 * (camera.lens.inUse()->resolution_px.height_px - 1);
  return frame_time_s + 1e-6 * camera.line_delay_us * (y_px - middle_px);
}

double timeOnClockOf_s(const CameraState& other, const CameraState& camera, double camera_time_s) {
  return sensorTime_s(other, referenceTime_s(camera, camera_time_s));
}

}  // namespace evical::ui
