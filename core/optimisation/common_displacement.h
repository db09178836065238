// Displacement that all circles of a view have in common: pixel thresholds have hysteresis, so that edges are seen with an
// offset that depends on the earlier motion. Neither a window's fit nor its covariance contains it.
//
// Each view has one unknown displacement d ~ N(0, S S^T), in units of the circles' noise scale. It is marginalised in closed
// form. In whitened coordinates the errors of a view have the covariance I + B B^T, where B stacks L_i^-1 S over the circles.
// The view's residuals and Jacobians are multiplied by
//   (I + B B^T)^(-1/2) = I + B G B^T,  G = V diag((1 / sqrt(1 + l) - 1) / l) V^T,  V diag(l) V^T = B^T B.
#pragma once

#include "core/data/board_observations.h"

#include <Eigen/Core>

#include <span>

namespace evical {

struct ModelOptions;

// S, ideal pixels. 0 for cameras that are not event cameras.
double commonDisplacement_px(CameraKind kind, const CircleObservation& circle, const ModelOptions& options);

class CommonDisplacement {
 public:
  // `roots`: L_i^-1 S of the circles of one view; empty without a displacement.
  explicit CommonDisplacement(std::span<const Eigen::Matrix2d> roots);

  // Multiplies the view's rows, two for each circle, of a row-major matrix of so many columns by (I + B B^T)^(-1/2).
  void whiten(double* matrix, Eigen::Index columns) const;

 private:
  Eigen::Matrix<double, Eigen::Dynamic, 2> roots_;    // B
  Eigen::Matrix<double, Eigen::Dynamic, 2> by_sums_;  // B G
};

}  // namespace evical
