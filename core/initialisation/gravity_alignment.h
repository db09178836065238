// Translations, gravity, accelerometer bias and the position spline, all linear once the rotation is known
// (docs/maths.md, 8.5): with control points P, lever t_c = reference_from_camera.translation of camera c,
// gravity g and bias b,
//   p(t_k) = p_wc(t_k) - R_wb(t_k) t_c        at every view,
//   p''(t) = R_wb(t) (f - b) + g              at every (averaged) accelerometer sample.
// Then again with scale p''(t), since accelerations determine metres: the board's true size relative to the
// given one.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/imu_sample.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/initialisation_options.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evical {

// Poses at camera time; imu time = camera time + offset.
struct CameraTrack {
  std::vector<CameraPose> poses;
  double time_offset_s = 0.0;
  std::optional<KnownVector> translation = {};  // reference_from_camera
};

struct GravityAlignment {
  VectorSpline imu_in_world_m;
  std::vector<Eigen::Vector3d> cameras_in_imu_m;
  Eigen::Vector3d gravity_in_world_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
  double position_rms_m = 0.0, acceleration_rms_m_s2 = 0.0;  // robust
  double lever_std_m = 0.0;                                  // of the worst direction of any camera
  int views = 0, outlying_views = 0;                         // outlying_views: inconsistent with the others
  double acceleration_misfit_m_s2 = 0.0;  // of the accelerations, from their median, without limits
  double board_scale = 1.0, board_scale_std = 0.0;
};

// Sign of the board's scale; negative for mirrored images and for negated accelerations
// (docs/maths.md, 8.13), 0 if it is not clear.
int signOfScale(const GravityAlignment& gravity, const InitialisationOptions& options);

// `rotation` (world_from_imu, IMU clock) determines range and knots.
GravityAlignment alignGravity(std::span<const CameraTrack> cameras, std::span<const ImuSample> samples,
                              std::int64_t start_ns, const So3Spline& rotation,
                              const InitialisationOptions& options, const RunContext& context = {});

// Only the median difference between accelerations and positions: faster.
double accelerationMisfit_m_s2(std::span<const CameraTrack> cameras, std::span<const ImuSample> samples,
                               std::int64_t start_ns, const So3Spline& rotation,
                               const InitialisationOptions& options, const RunContext& context = {});

// If all rotation is about one axis of the IMU, rotation does not determine the angle of the camera about it;
// accelerations do. Returns the angle by which world_from_imu must be rotated, R_wb Exp(axis * angle), for
// the best agreement.
double findTurnAboutAxis(const Eigen::Vector3d& axis_in_imu, std::span<const CameraTrack> cameras,
                         std::span<const ImuSample> samples, std::int64_t start_ns, const So3Spline& rotation,
                         const InitialisationOptions& options, const RunContext& context = {});

}  // namespace evical
