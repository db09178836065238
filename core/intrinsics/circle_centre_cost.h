// Residual of a measured circle relative to camera and pose, on the sensor (docs/maths.md, 7.1):
//   r = L^-1 [ distorted(centre of the projected circle's conic) + lead * effect - measured ],
// L the Cholesky factor of the centre's covariance. Without unit. A circle of radius 0 is a corner, which is
// projected directly, and therefore at any angle that the camera sees.
//
// Blocks: intrinsics (fx fy cx cy d0..d4), edge localisation bias [px], camera_from_board (x y z w, then
// metres). The pose's Jacobian is with respect to its manifold's step: three columns for the rotation, one of
// zeros, three for the translation.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/so3.h"
#include "core/intrinsics/sensor_views.h"

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>
#include <Eigen/Core>

#include <optional>

namespace evical {

inline constexpr int kPoseBlock = 7;

class CircleCentreCost final : public ceres::SizedCostFunction<2, 9, 1, kPoseBlock> {
 public:
  // `scale`: factor on all covariances, estimated from the residuals.
  CircleCentreCost(CameraModel model, const SensorCircle& circle, double radius_m, double scale);

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  const Eigen::Matrix2d& whitening_px() const { return whitening_px_; }  // of errors in px to residuals

 private:
  std::optional<Eigen::Vector2d> predict(const CameraIntrinsics& camera,
                                         const RigidTransform& camera_from_board,
                                         IntrinsicsJacobian* by_intrinsics,
                                         Eigen::Matrix<double, 2, 6>* by_pose) const;

  CameraModel model_;
  Eigen::Vector2d on_board_m_, centre_px_, lead_effect_;
  Eigen::Matrix2d whitening_px_;
  double radius_m_;
};

// Perturbed as rotation * Exp(delta) and translation + delta.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseBlock; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

RigidTransform poseFrom(const double* parameters);
void writePose(const RigidTransform& pose, double* parameters);

}  // namespace evical
