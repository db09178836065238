// Smoothness of a trajectory without an IMU: weak costs that determine stretches without views, and the
// acceleration that its views show, which is expected between them. A cost is zero for constant velocity, r =
// acceleration / sigma with the acceleration from three neighbouring control points, without unit.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

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

// RMS of each axis' acceleration over the control points that views determine; infinite without any.
struct TrajectorySmoothness {
  double rotation_rad_s2 = 0.0, position_m_s2 = 0.0;
};
TrajectorySmoothness trajectorySmoothness(const CalibrationInput& input, const CalibrationState& state);

}  // namespace evical
