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

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

struct ModelOptions;

// S, ideal pixels. 0 for cameras that are not event cameras.
double commonDisplacement_px(CameraKind kind, const CircleObservation& circle, const ModelOptions& options);

class CommonDisplacement {
 public:
  // `rows`: first of the two rows of each circle of one view in the residuals. `roots`: L_i^-1 S.
  CommonDisplacement(std::vector<Eigen::Index> rows, std::span<const Eigen::Matrix2d> roots);

  // Multiplies the view's rows of a row-major matrix of so many columns by (I + B B^T)^(-1/2).
  void whiten(double* matrix, Eigen::Index columns) const;
  const std::vector<Eigen::Index>& rows() const { return rows_; }

 private:
  std::vector<Eigen::Index> rows_;
  Eigen::Matrix<double, Eigen::Dynamic, 2> roots_;    // B
  Eigen::Matrix<double, Eigen::Dynamic, 2> by_sums_;  // B G
};

}  // namespace evical
