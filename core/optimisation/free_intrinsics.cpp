#include "core/optimisation/free_intrinsics.h"

#include "core/data/calibration_state.h"
#include "core/data/intrinsics_result.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/prior_cost.h"

#include <Eigen/LU>

#include <algorithm>
#include <vector>

namespace evical {
namespace {

// Ideal pixels of this camera are x/z, y/z.
const CameraIntrinsics& normalisedCamera() {
  static const CameraIntrinsics camera{
      CameraModel::PinholeRadtan, {1, 1}, Eigen::Vector2d::Ones(), Eigen::Vector2d::Zero(), {}};
  return camera;
}

}  // namespace

SeenCentre seenCentre(const CameraIntrinsics& seen_with, const Eigen::Vector2d& ideal_px) {
  return {ideal_px, pixelFromIdeal(seen_with, ideal_px), idealPixelScale(seen_with, ideal_px)};
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

IntrinsicsBlock::IntrinsicsBlock(const CameraIntrinsics& seen_with, const CameraState& state,
                                 const OptimisationOptions& options)
    : seen_with_(seen_with) {
  writeIntrinsics(state.lens.solved.value_or(seen_with), parameters_.data());
  writeIntrinsics(seen_with, prior_mean_.data());
  prior_sigma_.fill(options.camera_distortion_sigma);
  prior_sigma_[0] = options.camera_focal_length_sigma * seen_with.focal_length_px.x();
  prior_sigma_[1] = options.camera_focal_length_sigma * seen_with.focal_length_px.y();
  prior_sigma_[2] = prior_sigma_[3] = options.camera_principal_point_sigma_px;
  std::vector<int> unused;
  for (int i = 4 + distortionCount(seen_with); i < kIntrinsicsCount; ++i) unused.push_back(i);
  if (!unused.empty()) manifold_ = std::make_unique<ceres::SubsetManifold>(kIntrinsicsCount, unused);
}

void IntrinsicsBlock::hold(ceres::Problem& problem, bool released) {
  if (!problem.HasParameterBlock(data())) return;
  if (manifold_) problem.SetManifold(data(), manifold_.get());
  if (!released) problem.SetParameterBlockConstant(data());
}

ceres::ResidualBlockId IntrinsicsBlock::addPrior(ceres::Problem& problem) {
  using Vector = Eigen::Matrix<double, 9, 1>;
  auto* cost = new PriorCost(Vector(prior_mean_.data()), Vector(prior_sigma_.data()));
  return problem.AddResidualBlock(cost, nullptr, data());
}

}  // namespace evical
