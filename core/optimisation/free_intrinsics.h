// A camera's intrinsics as unknowns of the batch.
//
// Measured centres stay in the ideal pixels of the front end's camera model, in which covariances, leads and
// pixel errors are given. The prediction of another model is compared on the sensor and converted:
//   r = S [ project(camera, centre of the projected circle's conic) - distort(detection_intrinsics, measured)
//   ], S = d(ideal pixel)/d(pixel) of detection_intrinsics at the measured centre.
// If both models are equal, r is predicted - measured in ideal pixels, to second order in r.
#pragma once

#include "core/data/camera_lens.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <Eigen/Core>

#include <array>
#include <memory>
#include <optional>

namespace evical {

struct CameraState;
struct OptimisationOptions;

// Measured centre, prepared for comparison with the predictions of other intrinsics.
struct SeenCentre {
  Eigen::Vector2d ideal_px = Eigen::Vector2d::Zero();  // of detection_intrinsics
  Eigen::Vector2d sensor_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d ideal_from_sensor = Eigen::Matrix2d::Identity();  // S
};
SeenCentre seenCentre(const CameraIntrinsics& detection_intrinsics, const Eigen::Vector2d& ideal_px);

// projectCircle with the result in the ideal pixels of `seen`.
std::optional<ProjectedCircle> projectCircleBeside(const SeenCentre& seen, const CameraIntrinsics& camera,
                                                   const Eigen::Vector3d& centre_in_camera_m,
                                                   const Eigen::Vector3d& normal_in_camera, double radius_m,
                                                   IntrinsicsJacobian* by_intrinsics = nullptr);

// Ceres' block, fx fy cx cy d0..d4, with its prior. Its address is fixed, since Ceres points to it.
class IntrinsicsBlock {
 public:
  // Starts at the state's intrinsics, or otherwise at the detection intrinsics, which are the prior's mean.
  // The prior has the sigmas given for the lens, otherwise it is weak.
  IntrinsicsBlock(const CameraLens& lens, const CameraState& state, const OptimisationOptions& options);
  IntrinsicsBlock(const IntrinsicsBlock&) = delete;
  IntrinsicsBlock& operator=(const IntrinsicsBlock&) = delete;

  double* data() { return parameters_.data(); }
  CameraIntrinsics intrinsics() const {
    return intrinsicsFrom(parameters_.data(), seen_with_.model, seen_with_.resolution_px);
  }

  // Fixes the numbers that the model does not use, and all of them unless released. Call it for each new
  // problem that has the block.
  void hold(ceres::Problem& problem, bool released);
  ceres::ResidualBlockId addPrior(ceres::Problem& problem);

 private:
  CameraIntrinsics seen_with_;
  std::array<double, 9> parameters_{};
  IntrinsicsVector prior_mean_;
  IntrinsicsMatrix prior_weight_;              // residual from deviation
  std::unique_ptr<ceres::Manifold> manifold_;  // null if all nine are used
};

}  // namespace evical
