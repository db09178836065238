#include "core/optimisation/bias_knots.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// Sigma that fixes the knots' mean at 0, to separate it from the bias; far below measurable values.
constexpr double kGyroscopeMeanSigma_rad_s = 1e-7, kAccelerometerMeanSigma_m_s2 = 1e-6;

struct RandomWalks {
  double gyroscope, accelerometer;
};
RandomWalks randomWalks(const OptimisationOptions& options, const ImuNoise& noise) {
  const auto given = [](double walk, double otherwise) { return walk > 0.0 ? walk : otherwise; };
  return {given(noise.gyroscope_random_walk, options.gyroscope_random_walk),
          given(noise.accelerometer_random_walk, options.accelerometer_random_walk)};
}

void addPriorsOf(std::vector<Eigen::Vector3d>& knots, const BiasDrift& drift, double walk, double mean_sigma,
                 ceres::Problem& problem, std::vector<ceres::ResidualBlockId>& added) {
  std::vector<double*> blocks;
  for (Eigen::Vector3d& knot : knots) blocks.push_back(knot.data());
  const double step_sigma = walk * std::sqrt(drift.knot_spacing_s);
  for (std::size_t k = 1; k < blocks.size(); ++k)
    added.push_back(
        problem.AddResidualBlock(new BiasStepCost(step_sigma), nullptr, blocks[k - 1], blocks[k]));
  added.push_back(problem.AddResidualBlock(new BiasMeanCost(drift, mean_sigma), nullptr, blocks));
}

}  // namespace

bool BiasStepCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Map<const Eigen::Vector3d> before(parameters[0]), after(parameters[1]);
  Eigen::Map<Eigen::Vector3d>{residuals} = weight_ * (after - before);
  if (!jacobians) return true;
  if (jacobians[0]) jacobianRows<3, 3>(jacobians, 0, 0) = -weight_ * Eigen::Matrix3d::Identity();
  if (jacobians[1]) jacobianRows<3, 3>(jacobians, 1, 0) = weight_ * Eigen::Matrix3d::Identity();
  return true;
}

BiasMeanCost::BiasMeanCost(const BiasDrift& drift, double sigma) {
  for (std::size_t k = 0; k < drift.knots(); ++k) weights_.push_back(drift.weight(k) / sigma);
  mutable_parameter_block_sizes()->assign(drift.knots(), 3);
  set_num_residuals(3);
}

bool BiasMeanCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  Eigen::Map<Eigen::Vector3d> sum(residuals);
  sum.setZero();
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    sum += weights_[k] * Eigen::Map<const Eigen::Vector3d>(parameters[k]);
    if (jacobians && jacobians[k])
      jacobianRows<3, 3>(jacobians, static_cast<int>(k), 0) = weights_[k] * Eigen::Matrix3d::Identity();
  }
  return true;
}

void placeBiasKnots(const OptimisationOptions& options, const ImuNoise& noise, const So3Spline& trajectory,
                    ImuState& imu) {
  BiasDrift& drift = imu.bias_drift;
  if (!options.hasLinearBiases()) {
    drift = {};
    return;
  }
  if (drift.knots() >= 2) return;
  const double duration_s = trajectory.endTime_s() - trajectory.start_s;
  const RandomWalks walks = randomWalks(options, noise);
  const double spacing_s = std::min({options.bias_knot_spacing_s, noise.gyroscope_density / walks.gyroscope,
                                     noise.accelerometer_density / walks.accelerometer});
  const int steps =
      static_cast<int>(std::clamp(std::round(duration_s / spacing_s), 1.0, options.max_bias_knots - 1.0));
  drift.start_s = sensorTime_s(imu, trajectory.start_s);
  drift.knot_spacing_s = duration_s / steps;
  drift.gyroscope_rad_s.assign(static_cast<std::size_t>(steps) + 1, Eigen::Vector3d::Zero());
  drift.accelerometer_m_s2 = drift.gyroscope_rad_s;
}

bool sameBiasKnots(const ImuState& imu, double time_s, double other_s) {
  const BiasDrift& drift = imu.bias_drift;
  return drift.knots() < 2 || drift.segmentAt(time_s) == drift.segmentAt(other_s);
}

std::optional<DriftTimes> appendDriftBlocks(const BiasDrift& drift, std::vector<Eigen::Vector3d>& knots,
                                            double time_s, std::vector<double*>& blocks) {
  if (drift.knots() < 2) return std::nullopt;
  const std::size_t segment = drift.segmentAt(time_s);
  blocks.insert(blocks.end(), {knots[segment].data(), knots[segment + 1].data()});
  return DriftTimes{drift.knotTime_s(segment), drift.knot_spacing_s};
}

std::vector<ceres::ResidualBlockId> addDriftPriors(ceres::Problem& problem,
                                                   const OptimisationOptions& options, const ImuNoise& noise,
                                                   ImuState& imu) {
  std::vector<ceres::ResidualBlockId> added;
  BiasDrift& drift = imu.bias_drift;
  if (drift.knots() < 2 || !problem.HasParameterBlock(imu.gyroscope_bias_rad_s.data())) return added;
  const RandomWalks walks = randomWalks(options, noise);
  addPriorsOf(drift.gyroscope_rad_s, drift, walks.gyroscope, kGyroscopeMeanSigma_rad_s, problem, added);
  addPriorsOf(drift.accelerometer_m_s2, drift, walks.accelerometer, kAccelerometerMeanSigma_m_s2, problem,
              added);
  return added;
}

}  // namespace evical
