// Weak costs on a trajectory without an IMU, which determine stretches without views:
// zero for constant velocity, r = acceleration / sigma with the acceleration from three
// neighbouring control points, without unit.
#pragma once

#include <ceres/sized_cost_function.h>
#include <Eigen/Core>

namespace evical {

// Blocks: three quaternions (So3Manifold).
class SmoothRotationCost final : public ceres::SizedCostFunction<3, 4, 4, 4> {
 public:
  SmoothRotationCost(double knot_spacing_s, double sigma_rad_s2);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double weight_;
};

// Blocks: three positions [m].
class SmoothPositionCost final : public ceres::SizedCostFunction<3, 3, 3, 3> {
 public:
  SmoothPositionCost(double knot_spacing_s, double sigma_m_s2);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double weight_;
};

}  // namespace evical
