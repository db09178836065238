// A camera's intrinsics as unknowns of the batch.
//
// Measured centres stay in the ideal pixels of the camera that the front end saw with: there,
// covariances, leads and the pixels' errors are known. What another camera predicts is compared on
// the sensor and brought there:
//   r = S [ project(camera, centre of the projected circle's conic) - distort(detection_intrinsics, measured) ],
//   S = d(ideal pixel)/d(pixel) of detection_intrinsics at the measured centre.
// Where the camera is the one seen with, r is predicted - measured in ideal pixels, to second order in r.
#pragma once

#include "core/data/camera_lens.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/intrinsics_numbers.h"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <Eigen/Core>

#include <array>
#include <memory>
#include <optional>

namespace evical {

struct CameraState;
struct OptimisationOptions;

// A measured centre, ready to be compared with what other intrinsics predict.
struct SeenCentre {
  Eigen::Vector2d ideal_px = Eigen::Vector2d::Zero();  // of the camera that was seen with
  Eigen::Vector2d sensor_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d ideal_from_sensor = Eigen::Matrix2d::Identity();  // S
};
SeenCentre seenCentre(const CameraIntrinsics& detection_intrinsics, const Eigen::Vector2d& ideal_px);

// As projectCircle, with the result in the ideal pixels that `seen` is in.
std::optional<ProjectedCircle> projectCircleBeside(const SeenCentre& seen, const CameraIntrinsics& camera,
                                                   const Eigen::Vector3d& centre_in_camera_m,
                                                   const Eigen::Vector3d& normal_in_camera, double radius_m,
                                                   IntrinsicsJacobian* by_intrinsics = nullptr);

// Ceres' block, fx fy cx cy d0..d4, with what is known of it. Stays where it is: Ceres points into it.
class IntrinsicsBlock {
 public:
  // Starts at the state's intrinsics, or else at those seen with, around which the prior is: as wide as is said of a
  // given lens, else weak.
  IntrinsicsBlock(const CameraLens& lens, const CameraState& state, const OptimisationOptions& options);
  IntrinsicsBlock(const IntrinsicsBlock&) = delete;
  IntrinsicsBlock& operator=(const IntrinsicsBlock&) = delete;

  double* data() { return parameters_.data(); }
  CameraIntrinsics intrinsics() const {
    return intrinsicsFrom(parameters_.data(), seen_with_.model, seen_with_.resolution_px);
  }

  // Holds what the model does not use; all of it, unless released. To be called for each new
  // problem that has the block.
  void hold(ceres::Problem& problem, bool released);
  ceres::ResidualBlockId addPrior(ceres::Problem& problem);

 private:
  CameraIntrinsics seen_with_;
  std::array<double, 9> parameters_{};
  IntrinsicsVector prior_mean_;
  IntrinsicsMatrix prior_weight_;              // of what is off the mean, so that it becomes a residual
  std::unique_ptr<ceres::Manifold> manifold_;  // none where all nine are used
};

}  // namespace evical
