// Translations, gravity, accelerometer bias and the position spline, all linear once the rotation is known
// (docs/maths.md, 8.5): with control points P, lever t_c = reference_from_camera.translation of camera c,
// gravity g and bias b,
//   p(t_k) = p_wc(t_k) - R_wb(t_k) t_c        at every view,
//   p''(t) = R_wb(t) (f - b) + g              at every (averaged) accelerometer sample.
// Then once more with scale p''(t), since accelerations determine metres: the board's true size over the
// given one.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_priors.h"
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

// Poses at camera time; imu time = that + offset.
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
  int views = 0, outlying_views = 0;                         // far from where the others put the camera
  double acceleration_misfit_m_s2 = 0.0;  // of the accelerations by their median, however large
  double board_scale = 1.0, board_scale_std = 0.0;
};

// `rotation` (world_from_imu, IMU clock) gives range and knots.
GravityAlignment alignGravity(std::span<const CameraTrack> cameras, std::span<const ImuSample> samples,
                              std::int64_t start_ns, const So3Spline& rotation,
                              const InitialisationOptions& options, const RunContext& context = {});

// Median difference between accelerations and positions, and nothing else: faster.
double accelerationMisfit_m_s2(std::span<const CameraTrack> cameras, std::span<const ImuSample> samples,
                               std::int64_t start_ns, const So3Spline& rotation,
                               const InitialisationOptions& options, const RunContext& context = {});

// When all rotation is about one axis of the IMU, rotation alone leaves the angle of the camera about it
// open; accelerations don't. The angle by which world_from_imu must be turned, R_wb Exp(axis * angle), so
// that both agree best.
double findTurnAboutAxis(const Eigen::Vector3d& axis_in_imu, std::span<const CameraTrack> cameras,
                         std::span<const ImuSample> samples, std::int64_t start_ns, const So3Spline& rotation,
                         const InitialisationOptions& options, const RunContext& context = {});

}  // namespace evical
