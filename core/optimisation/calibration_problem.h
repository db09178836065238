// The batch's unknowns and cost functions as a Ceres problem.
#pragma once

#include "core/optimisation/parameter_blocks.h"
#include "core/optimisation/problem_builder.h"
#include "core/optimisation/view_circles.h"
#include "core/optimisation/view_cost.h"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sphere_manifold.h>

#include <memory>
#include <vector>

namespace evical {

// Quaternion blocks (x y z w, as Eigen stores them) perturbed on the right: R -> R Exp(delta).
//
// PlusJacobian is [I; 0]: cost functions write derivatives with respect to delta into the first three of the
// four columns, and zero into the last. This avoids the chain rule through the quaternion. These blocks'
// Jacobians can therefore not be compared with derivatives by the quaternion's numbers.
class So3Manifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

class CalibrationProblem {
 public:
  // Keeps a reference to input and options.
  CalibrationProblem(const CalibrationInput& input, const OptimisationOptions& options,
                     const CalibrationState& initial);
  CalibrationProblem(const CalibrationProblem&) = delete;
  CalibrationProblem& operator=(const CalibrationProblem&) = delete;

  // Assigns every measurement to its spline segment at the current time offsets.
  void build(ParameterStages stage, const Weights& weights);

  ceres::Problem& problem() { return *problem_; }
  const std::vector<BlockInfo>& blocks() const { return residuals_; }

  // Change of the time offsets since build(), in knots.
  double segmentDrift_knots() const;

  CalibrationState state() const { return parameters_.state(); }  // current values of the blocks
  std::vector<Quantity> quantities();                             // free in the built problem
  std::vector<double*> splineBlocks();                            // in the built problem, in order of time
  // Blocks of biases at their knots: by IMU, gyroscopes first, in order of time.
  std::vector<Quantity> driftBlocks();

 private:
  void setManifolds(ProblemBuilder& builder);
  void holdReferenceCamera(ProblemBuilder& builder);

  const CalibrationInput& input_;
  const OptimisationOptions& options_;
  ParameterBlocks parameters_;
  std::vector<CircleModel> circle_models_;  // by camera; cost functions point to them
  std::vector<PixelErrors> pixel_errors_;   // by camera
  std::vector<double> assigned_offsets_s_;  // at both ends; cameras, then IMUs

  So3Manifold so3_;
  ceres::SphereManifold<3> sphere_;
  std::vector<BlockInfo> residuals_;
  std::unique_ptr<ceres::Problem> problem_;  // destroyed before the objects it points to
};

}  // namespace evical
