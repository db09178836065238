#include "core/optimisation/free_intrinsics.h"

#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/prior_cost.h"
#include "core/optimisation/weak_priors.h"

#include "core/data/calibration_state.h"
#include "core/data/intrinsics_result.h"
#include "core/geometry/camera_model.h"

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

}  // namespace evical
