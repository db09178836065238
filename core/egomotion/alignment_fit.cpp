#include "core/egomotion/alignment_fit.h"

#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kMedianOfChi2With3 = 2.3659738843753377;
constexpr double kCauchySquares =
    9.0;  // squared scale; errors of one sigma in three numbers are far below it

}  // namespace

AlignmentFit::AlignmentFit(std::vector<const WindowMotion*> windows, const SummedRates& rates,
                           const Eigen::Matrix3d& gyroscope_matrix)
    : windows_(std::move(windows)), rates_(rates), imu_from_measured_(gyroscope_matrix.inverse()) {}

Eigen::Vector3d AlignmentFit::imuRate_rad_s(const WindowMotion& window, const AlignmentState& state,
                                            Eigen::Vector3d* by_time) const {
  constexpr auto kParts = static_cast<double>(WindowMotion::kParts);
  const double part_s = (window.end_s - window.begin_s) / kParts;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < WindowMotion::kParts; ++k) {
    const double weight = window.part_weights[k];
    if (weight == 0.0) continue;
    const double from_s = window.begin_s + static_cast<double>(k) * part_s + state.time_offset_s;
    mean += weight * rates_.mean_rad_s(from_s, from_s + part_s);
    if (by_time)
      slope += weight / part_s * (rates_.rateAt_rad_s(from_s + part_s) - rates_.rateAt_rad_s(from_s));
  }
  if (by_time) *by_time = imu_from_measured_ * slope;
  return imu_from_measured_ * (mean - state.bias_rad_s);
}

AlignmentFit::Equation AlignmentFit::equationOf(std::size_t k, const AlignmentState& state) const {
  const WindowMotion& window = *windows_[k];
  Eigen::Vector3d by_time;
  const Eigen::Vector3d in_imu = imuRate_rad_s(window, state, &by_time);
  const Eigen::Matrix3d camera_from_imu = state.scale * state.imu_from_camera.transpose();
  Equation equation;
  equation.error = camera_from_imu * in_imu - window.rate_rad_s;
  equation.jacobian.leftCols<3>() = camera_from_imu * skew(in_imu);
  equation.jacobian.col(3) = camera_from_imu * by_time;
  equation.jacobian.block<3, 3>(0, 4) = -camera_from_imu * imu_from_measured_;
  equation.jacobian.col(7) = state.imu_from_camera.transpose() * in_imu;
  return equation;
}

Eigen::Matrix3d AlignmentFit::weightOf(std::size_t k, const Eigen::Vector3d& error, double* square) const {
  const Eigen::Matrix3d covariance =
      windows_[k]->covariance + floor_rad_s_ * floor_rad_s_ * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d information = covariance.inverse() / (scale_ * scale_);
  const double size = error.dot(information * error);
  if (square) *square = size;
  return cauchyWeight(size / kCauchySquares) * information;
}

// The windows' own sigmas are valid for few edges; for many edges, model errors dominate.
void AlignmentFit::findScales(const AlignmentState& state) {
  std::vector<double> sizes, squares;
  std::vector<Eigen::Vector3d> errors;
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    errors.push_back(equationOf(k, state).error);
    for (const double error : errors.back()) sizes.push_back(std::abs(error));
  }
  median_error_rad_s_ = medianOf(std::move(sizes));
  constexpr double kShare = 0.5;
  floor_rad_s_ = std::max(kShare * kMadToSigma * median_error_rad_s_, 1e-6);
  scale_ = 1.0;
  squares_.resize(windows_.size());
  for (std::size_t k = 0; k < windows_.size(); ++k) weightOf(k, errors[k], &squares_[k]);
  scale_ = std::sqrt(std::max(medianOf(std::vector<double>(squares_)) / kMedianOfChi2With3, 1e-12));
  for (double& square : squares_) square /= scale_ * scale_;
}

AlignmentFit::NormalEquations AlignmentFit::normalEquations(const AlignmentState& state) const {
  NormalEquations all;
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    const Equation equation = equationOf(k, state);
    const Eigen::Matrix3d weight = weightOf(k, equation.error);
    all.normal += equation.jacobian.transpose() * weight * equation.jacobian;
    all.gradient += equation.jacobian.transpose() * (weight * equation.error);
  }
  return all;
}

bool AlignmentFit::solve(AlignmentState& state) {
  constexpr int kIterations = 20;
  constexpr double kLargestTurn_rad = 0.5, kLargestDelay_s = 0.02, kDone = 1e-9;
  for (int k = 0; k < kIterations; ++k) {
    findScales(state);
    const NormalEquations all = normalEquations(state);
    AlignmentVector step = -all.normal.ldlt().solve(all.gradient);
    if (!step.allFinite()) return false;
    const double turn_rad = step.head<3>().norm();
    step *= std::min({1.0, kLargestTurn_rad / std::max(turn_rad, 1e-12),
                      kLargestDelay_s / std::max(std::abs(step[3]), 1e-12)});
    state.imu_from_camera = so3Exp(step.head<3>()) * state.imu_from_camera;
    state.time_offset_s += step[3];
    state.bias_rad_s += step.segment<3>(4);
    state.scale += step[7];
    if (!(state.scale > 0.0)) return false;
    if (step.norm() < kDone) break;
  }
  findScales(state);
  return true;
}

}  // namespace evical
