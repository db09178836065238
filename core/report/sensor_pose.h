// Where each sensor of a result sits against the reference, and how that is said.
#pragma once

#include "core/report/result_yaml.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Takes points of the sensor to the reference: p_reference = R p_sensor + t.
struct SensorPose {
  enum class Kind { Camera, Imu };

  std::string sensor, reference;
  Kind kind = Kind::Camera, reference_kind = Kind::Imu;
  RigidTransform reference_from_sensor;
  double time_offset_s = 0.0;  // t_reference = t_sensor + that
  std::size_t number = 0;      // among the cameras, or the IMUs
  // Of rigs without an IMU: programs chain their cameras, each to the one before it.
  std::optional<RigidTransform> camera_from_camera_before = {};
};

// Cameras, then IMUs; the reference, which sits at itself, is none of them.
std::vector<SensorPose> sensorPoses(const NamedResult& named);

// "takes points of left to left_imu: p_left_imu = R p_left + t"
std::string directionWords(const SensorPose& pose);

// A warning where roll and yaw turn about the same axis, or nearly: they cannot be told apart there, and change wildly
// with the last digit. Empty elsewhere.
std::string anglesWarning(const Eigen::Vector3d& roll_pitch_yaw_deg);

}  // namespace evical
