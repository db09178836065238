#include "core/intrinsics/circle_centre_cost.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>

namespace evical {
namespace {

constexpr double kNowhere_sigma = 1e3;  // so large that no step is accepted there

}  // namespace

RigidTransform poseFrom(const double* p) {
  return {Eigen::Map<const Eigen::Quaterniond>(p), Eigen::Map<const Eigen::Vector3d>(p + 4)};
}

void writePose(const RigidTransform& pose, double* p) {
  std::copy_n(pose.rotation.coeffs().data(), 4, p);
  std::copy_n(pose.translation_m.data(), 3, p + 4);
}

CircleCentreCost::CircleCentreCost(CameraModel model, const SensorCircle& circle, double radius_m,
                                   double scale)
    : model_(model),
      on_board_m_(circle.on_board_m),
      centre_px_(circle.centre_px),
      lead_effect_(circle.lead_effect),
      whitening_px_(
          Eigen::LLT<Eigen::Matrix2d>(circle.covariance_px2).matrixL().solve(Eigen::Matrix2d::Identity()) /
          scale),
      radius_m_(radius_m) {}

std::optional<Eigen::Vector2d> CircleCentreCost::predict(const CameraIntrinsics& camera,
                                                         const RigidTransform& camera_from_board,
                                                         IntrinsicsJacobian* by_intrinsics,
                                                         Eigen::Matrix<double, 2, 6>* by_pose) const {
  Eigen::Matrix<double, 2, 3> by_point;
  if (radius_m_ == 0.0) {
    const Eigen::Matrix3d rotation = camera_from_board.rotation.toRotationMatrix();
    const Eigen::Vector3d on_board(on_board_m_.x(), on_board_m_.y(), 0.0);
    const auto pixel =
        project(camera, rotation * on_board + camera_from_board.translation_m, &by_point, by_intrinsics);
    if (!pixel) return std::nullopt;
    *by_pose << -by_point * rotation * skew(on_board), by_point;
    return pixel;
  }
  Eigen::Matrix<double, 2, 6> centre_by_pose;
  const auto centre =
      projectedCircleCentre(normalisedCamera(), camera_from_board, on_board_m_, radius_m_, &centre_by_pose);
  if (!centre) return std::nullopt;
  const auto pixel = project(camera, centre->homogeneous(), &by_point, by_intrinsics);
  if (!pixel) return std::nullopt;
  *by_pose = by_point.leftCols<2>() * centre_by_pose;
  return pixel;
}

bool CircleCentreCost::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  Eigen::Map<Eigen::Vector2d> residual(residuals);
  const CameraIntrinsics camera = intrinsicsFrom(parameters[0], model_, {});
  const double lead_px = *parameters[1];
  const RigidTransform camera_from_board = poseFrom(parameters[2]);
  Eigen::Matrix<double, 2, 6> by_pose;
  IntrinsicsJacobian by_intrinsics;
  const auto pixel = predict(camera, camera_from_board, &by_intrinsics, &by_pose);
  if (!pixel) {
    residual.setConstant(kNowhere_sigma);
    const auto& sizes = parameter_block_sizes();
    for (std::size_t block = 0; jacobians && block < sizes.size(); ++block)
      if (jacobians[block]) std::fill_n(jacobians[block], 2 * sizes[block], 0.0);
    return true;
  }
  residual = whitening_px_ * (*pixel + lead_px * lead_effect_ - centre_px_);
  if (!jacobians) return true;
  if (jacobians[0]) {
    Eigen::Map<Eigen::Matrix<double, 2, 9, Eigen::RowMajor>> by_block(jacobians[0]);
    by_block = whitening_px_ * by_intrinsics;
  }
  if (jacobians[1]) {
    Eigen::Map<Eigen::Vector2d> by_block(jacobians[1]);
    by_block = whitening_px_ * lead_effect_;
  }
  if (jacobians[2]) {
    Eigen::Map<Eigen::Matrix<double, 2, kPoseBlock, Eigen::RowMajor>> by_block(jacobians[2]);
    by_pose = (whitening_px_ * by_pose).eval();
    by_block << by_pose.leftCols<3>(), Eigen::Vector2d::Zero(), by_pose.rightCols<3>();
  }
  return true;
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  RigidTransform pose = poseFrom(x);
  pose.rotation = (pose.rotation * quaternionExp({delta[0], delta[1], delta[2]})).normalized();
  pose.translation_m += Eigen::Vector3d(delta[3], delta[4], delta[5]);
  writePose(pose, x_plus_delta);
  return true;
}

bool PoseManifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> j(jacobian);
  j.setZero();
  j.topLeftCorner<3, 3>().setIdentity();
  j.bottomRightCorner<3, 3>().setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const RigidTransform to = poseFrom(y), from = poseFrom(x);
  Eigen::Map<Eigen::Matrix<double, 6, 1>> difference(y_minus_x);
  difference << quaternionLog(from.rotation.conjugate() * to.rotation), to.translation_m - from.translation_m;
  return true;
}

bool PoseManifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> j(jacobian);
  j.setZero();
  j.topLeftCorner<3, 3>().setIdentity();
  j.bottomRightCorner<3, 3>().setIdentity();
  return true;
}

}  // namespace evical
