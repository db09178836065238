// Drifting biases: their knots and the prior. The bias at a knot is its mean over time, an ordinary quantity,
// plus the knot's own block. Knot blocks have the mean 0, and neighbours differ by 0 +- walk sqrt(knot
// spacing), a random walk's step.
#pragma once

#include "core/optimisation/inertial_cost.h"
#include "core/optimisation/optimisation_options.h"

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

// Zero if neighbouring knots are equal: r = (after - before) / sigma, without unit. Blocks: both knots.
class BiasStepCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit BiasStepCost(double sigma) : weight_(1.0 / sigma) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double weight_;
};

// Zero if knots have the mean 0: r = sum weight_k knot_k / sigma, without unit. Blocks: all knots.
class BiasMeanCost final : public ceres::CostFunction {
 public:
  BiasMeanCost(const BiasDrift& drift, double sigma);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  std::vector<double> weights_;
};

// Knots as the options request: none, or over all of `trajectory`; existing knots are kept. With a strong
// random walk the knots are so close that straight lines deviate from the walk by no more than the noise.
void placeBiasKnots(const OptimisationOptions& options, const ImuNoise& noise, const So3Spline& trajectory,
                    ImuState& imu);

// True if two times on the IMU's own clock are between the same knots.
bool sameBiasKnots(const ImuState& imu, double time_s, double other_s);

// Blocks of a cost function of samples between two knots, the first at `time_s` on the IMU's own clock;
// nullopt and no blocks if biases are constant. `knots`: the gyroscope's or the accelerometer's in `drift`.
std::optional<DriftTimes> appendDriftBlocks(const BiasDrift& drift, std::vector<Eigen::Vector3d>& knots,
                                            double time_s, std::vector<double*>& blocks);

// For an IMU in the problem. Random walks come from the noise model, otherwise from the options.
std::vector<ceres::ResidualBlockId> addDriftPriors(ceres::Problem& problem,
                                                   const OptimisationOptions& options, const ImuNoise& noise,
                                                   ImuState& imu);

// Position of a measurement's rows in Ceres' row-major Jacobian blocks, as a cost function writes them.

template <int Rows, int Columns>
auto jacobianRows(double** jacobians, int block, Eigen::Index first_row) {
  constexpr int kOrder = Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor;
  return Eigen::Map<Eigen::Matrix<double, Rows, Columns, kOrder>>(jacobians[block] + first_row * Columns);
}

// A quaternion block, calibration_problem.h: the last of the four columns is unused.
template <int Rows>
void writeRotationRows(double** jacobians, int block, Eigen::Index first_row,
                       const Eigen::Matrix<double, Rows, 3>& by_delta) {
  auto rows = jacobianRows<Rows, 4>(jacobians, block, first_row);
  rows.template leftCols<3>() = by_delta;
  rows.col(3).setZero();
}

}  // namespace evical
