// Pose of each sensor of a result relative to the reference, and its description.
#pragma once

#include "core/report/result_yaml.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Transforms points of the sensor to the reference: p_reference = R p_sensor + t.
struct SensorPose {
  enum class Kind { Camera, Imu };

  std::string sensor, reference;
  Kind kind = Kind::Camera, reference_kind = Kind::Imu;
  RigidTransform reference_from_sensor;
  double time_offset_s = 0.0;  // t_reference = t_sensor + that
  std::size_t number = 0;      // among the cameras, or the IMUs
  // Rigs without an IMU: other programs chain the cameras, each to the previous one.
  std::optional<RigidTransform> camera_from_camera_before = {};
};

// Cameras, then IMUs, without the reference.
std::vector<SensorPose> sensorPoses(const NamedResult& named);

// "transforms points of left to left_imu: p_left_imu = R p_left + t"
std::string directionWords(const SensorPose& pose);

// Warning if roll and yaw rotate about almost the same axis (gimbal lock): they are not separable, and change
// by a large amount with the last digit. Otherwise empty.
std::string anglesWarning(const Eigen::Vector3d& roll_pitch_yaw_deg);

}  // namespace evical
