#include "core/report/sensor_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {

std::vector<SensorPose> sensorPoses(const NamedResult& named) {
  using Kind = SensorPose::Kind;
  const CalibrationState& state = named.result->state;
  const bool by_camera =
      std::any_of(named.cameras.begin(), named.cameras.end(),
                  [&](const SensorDescription& camera) { return camera.name == named.reference; });
  const Kind reference_kind = by_camera ? Kind::Camera : Kind::Imu;
  std::vector<SensorPose> poses;
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    const CameraState& camera = state.cameras[i];
    if (named.cameras.at(i).name == named.reference) continue;
    poses.push_back({named.cameras[i].name, named.reference, Kind::Camera, reference_kind,
                     camera.reference_from_camera, camera.time_offset_s, i});
    if (by_camera && i > 0)
      poses.back().camera_from_camera_before =
          inverse(camera.reference_from_camera) * state.cameras[i - 1].reference_from_camera;
  }
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    if (named.imus.at(i).name == named.reference) continue;
    poses.push_back({named.imus[i].name, named.reference, Kind::Imu, reference_kind,
                     state.imus[i].reference_from_imu, state.imus[i].time_offset_s, i});
  }
  return poses;
}

std::string directionWords(const SensorPose& pose) {
  return fmt::format("transforms points of {0} to {1}: p_{1} = R p_{0} + t", pose.sensor, pose.reference);
}

std::string anglesWarning(const Eigen::Vector3d& roll_pitch_yaw_deg) {
  constexpr double kQuarterTurn_deg = 90.0, kNear_deg = 1.0;
  if (std::abs(std::abs(roll_pitch_yaw_deg.y()) - kQuarterTurn_deg) > kNear_deg) return {};
  return "angles are not unique here: use the quaternion";
}

}  // namespace evical
