// Hand-eye rotation with a free time offset and gyroscope bias from pairs of poses (docs/maths.md, 8.4):
//   log(imu rotation over the pair) = R_ic log(camera rotation over the pair) + bias * duration.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/camera_poses.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace evical {

// Rotation of a sensor relative to the reference, and its time offset: of a camera by hand-eye calibration,
// or of a further IMU from its gyroscope.
struct RelativeRotation {
  Eigen::Quaterniond reference_from_sensor = Eigen::Quaterniond::Identity();
  double time_offset_s = 0.0;
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();
  double residual_rad = 0.0;  // robust RMS over pairs
  double cost = 0.0;          // mean of log(1 + (error / scale)^2): compares offsets
  double axis_ratio = 0.0;    // rotation about the second axis relative to the first: 0 for one axis only
  Eigen::Vector3d main_axis_in_imu = Eigen::Vector3d::UnitX();
  int pairs = 0;
};

// Rotation of the camera between two views.
struct RotationPair {
  double from_s, to_s;       // camera clock
  Eigen::Vector3d seen_rad;  // camera(from)_from_camera(to), rotation vector
};
// Pairs each view with the next one that is at least `pair_gap_s` later, but at most `max_pair_s`.
std::vector<RotationPair> rotationPairs(const std::vector<CameraPose>& poses, double pair_gap_s,
                                        double max_pair_s);

// Needs a start offset with an error below `time_offset_reach_s`; a given offset or rotation of the prior is
// fixed. Empty if fewer than five pairs are covered.
std::optional<RelativeRotation> estimateCameraImuRotation(const std::vector<CameraPose>& poses,
                                                          const GyroRotation& gyro, double time_offset_s,
                                                          const InitialisationOptions& options,
                                                          const SensorPrior& prior = {});

}  // namespace evical
