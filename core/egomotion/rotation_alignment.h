// Rotation and time offset between a camera and an IMU, from their angular rates (docs/maths.md, 16.3 and
// 16.4):
//   scale * camera_from_imu * M^-1 (rate_measured(t + time_offset) - bias) = rate_of_camera(t).
// First from the windows' rates, then from all edges at once. The scale is that of the image's motion. It is
// not a result, and absorbs any common scale error of the rates.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_state.h"
#include "core/data/imu_sample.h"
#include "core/egomotion/camera_record.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/lens_rays.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct GyroscopeRecord {
  std::span<const ImuSample> samples;
  std::int64_t start_ns = 0;  // of the recording
  const ImuState& imu;        // its matrix is used unchanged, its bias as start value
};

struct AlignmentStart {
  Eigen::Quaterniond imu_from_camera = Eigen::Quaterniond::Identity();
  double time_offset_s = 0.0;  // imu_time = camera_time + time_offset_s
};

struct RotationAlignment {
  std::string failure;              // reason for a missing result; empty if there is one
  std::vector<std::string> advice;  // by the reasons for unused windows; empty if the windows suffice
  Eigen::Quaterniond imu_from_camera = Eigen::Quaterniond::Identity();
  double time_offset_s = 0.0;
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();
  double scale = 1.0;
  // Covariance of the rotation about the IMU's axes [rad] and of the time offset [s]: from the scatter of
  // blocks of the recording, and the remaining effects of depths and translation.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  int blocks = 0;
  // Changes of the same numbers with half as many depths across and down, and with all motion taken as
  // rotation: the dependence on depths and on translation.
  Eigen::Vector4d by_coarser_depths = Eigen::Vector4d::Zero(), by_turning_alone = Eigen::Vector4d::Zero();
  double rate_rms_rad_s = 0.0, misfit_rms_rad_s = 0.0;  // of the camera's rotation, and of its residuals
  Eigen::Vector3d weakest_in_camera = Eigen::Vector3d::Zero();  // axis of the least certain rotation

  bool found() const { return failure.empty(); }
};

// Marks windows that the gyroscope does not cover, or that contradict the others. Throws Cancelled.
RotationAlignment alignRotation(CameraRecord& record, const LensRays& lens, const GyroscopeRecord& gyroscope,
                                const AlignmentStart& start, const EgomotionOptions& options, int threads,
                                const RunContext& context = {});

}  // namespace evical
