#include "core/optimisation/free_intrinsics.h"

#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/prior_cost.h"

#include "core/data/calibration_state.h"
#include "core/data/intrinsics_result.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/sphere_lens.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

namespace evical {
SeenCentre seenCentre(const CameraIntrinsics& detection_intrinsics, const Eigen::Vector2d& ideal_px) {
  return {ideal_px, pixelFromIdeal(detection_intrinsics, ideal_px),
          idealPixelScale(detection_intrinsics, ideal_px)};
}

std::optional<ProjectedCircle> projectCircleBeside(const SeenCentre& seen, const CameraIntrinsics& camera,
                                                   const Eigen::Vector3d& centre_in_camera_m,
                                                   const Eigen::Vector3d& normal_in_camera, double radius_m,
                                                   IntrinsicsJacobian* by_intrinsics) {
  auto projected = projectCircle(normalisedCamera(), centre_in_camera_m, normal_in_camera, radius_m);
  if (!projected) return std::nullopt;
  Eigen::Matrix<double, 2, 3> by_ray;
  const auto pixel = project(camera, projected->centre_px.homogeneous(), &by_ray, by_intrinsics);
  if (!pixel) return std::nullopt;
  const Eigen::Matrix2d ideal_from_normalised = seen.ideal_from_sensor * by_ray.leftCols<2>();
  projected->centre_px = seen.ideal_px + seen.ideal_from_sensor * (*pixel - seen.sensor_px);
  projected->by_centre = (ideal_from_normalised * projected->by_centre).eval();
  projected->by_normal = (ideal_from_normalised * projected->by_normal).eval();
  if (by_intrinsics) *by_intrinsics = (seen.ideal_from_sensor * *by_intrinsics).eval();
  return projected;
}

IntrinsicsBlock::IntrinsicsBlock(const CameraLens& lens, const CameraState& state,
                                 const OptimisationOptions& options)
    : seen_with_(*lens.detection_intrinsics) {
  writeIntrinsics(state.lens.solved.value_or(seen_with_), parameters_.data());
  writeIntrinsics(seen_with_, prior_mean_.data());
  const IntrinsicsMatrix covariance = lensPriorCovariance(lens, options);
  prior_weight_ = covariance.llt().matrixL().solve(IntrinsicsMatrix::Identity());
  std::vector<int> unused;
  for (int i = 4 + distortionCount(seen_with_); i < kIntrinsicsCount; ++i) unused.push_back(i);
  if (!unused.empty()) manifold_ = std::make_unique<ceres::SubsetManifold>(kIntrinsicsCount, unused);
}

void IntrinsicsBlock::hold(ceres::Problem& problem, bool released) {
  if (!problem.HasParameterBlock(data())) return;
  if (manifold_) problem.SetManifold(data(), manifold_.get());
  const IntrinsicsBounds bounds = intrinsicsBounds(seen_with_.model);
  for (int i = 0; i < kIntrinsicsCount; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!std::isfinite(bounds.lower[k])) continue;
    problem.SetParameterLowerBound(data(), i, bounds.lower[k]);
    problem.SetParameterUpperBound(data(), i, bounds.upper[k]);
  }
  if (!released) problem.SetParameterBlockConstant(data());
}

ceres::ResidualBlockId IntrinsicsBlock::addPrior(ceres::Problem& problem) {
  auto* cost = new PriorCost(prior_mean_, PriorCost::InverseFactor{prior_weight_});
  return problem.AddResidualBlock(cost, nullptr, data());
}

namespace {

// Models with spheres: f and xi are strongly correlated, so the prior is on f / (1 + xi).
void holdScaleRatherThanLength(const CameraIntrinsics& camera, IntrinsicsMatrix& covariance) {
  constexpr int kXi = 4;
  if (!hasCentresApart(camera.model)) return;
  const Eigen::Vector2d by_xi = idealFocalLength_px(camera);
  covariance.topLeftCorner<2, 2>() += covariance(kXi, kXi) * by_xi * by_xi.transpose();
  covariance.block<2, 1>(0, kXi) = covariance(kXi, kXi) * by_xi;
  covariance.block<1, 2>(kXi, 0) = covariance.block<2, 1>(0, kXi).transpose();
}

}  // namespace

IntrinsicsMatrix lensPriorCovariance(const CameraLens& lens, const OptimisationOptions& options) {
  IntrinsicsVector weak = IntrinsicsVector::Constant(options.camera_distortion_sigma);
  weak.head<2>() = options.camera_focal_length_sigma * lens.detection_intrinsics->focal_length_px;
  weak.segment<2>(2).setConstant(options.camera_principal_point_sigma_px);
  IntrinsicsMatrix covariance = weak.cwiseAbs2().asDiagonal();
  if (!lens.given_with) {
    holdScaleRatherThanLength(*lens.detection_intrinsics, covariance);
    return covariance;
  }
  const IntrinsicsMatrix given = lens.given_with->covariance();
  // Rounded correlations may not be positive definite; this is far below their rounding.
  constexpr double kRounded = 1e-3;
  for (int i = 0; i < kIntrinsicsCount; ++i) {
    if (given(i, i) <= 0.0) continue;
    for (int j = 0; j < kIntrinsicsCount; ++j)
      if (given(j, j) > 0.0) covariance(i, j) = given(i, j) * (i == j ? 1.0 + kRounded : 1.0);
  }
  return covariance;
}

}  // namespace evical
