// Cost functions of priors.
#pragma once

#include "core/geometry/so3.h"
#include "core/optimisation/inertial_cost.h"

#include <ceres/sized_cost_function.h>
#include <Eigen/Core>

#include <utility>

namespace evical {

// Zero if a block has its prior's mean: r = (block - mean) / sigma, without unit; for correlated numbers
// r = L^-1 (block - mean), L the Cholesky factor of their covariance. Block: numbers.
class PriorCost final : public ceres::CostFunction {
 public:
  struct InverseFactor {
    Eigen::MatrixXd matrix;  // L^-1
  };

  PriorCost(const Eigen::VectorXd& mean, const Eigen::VectorXd& sigma)
      : PriorCost(mean, InverseFactor{sigma.cwiseInverse().asDiagonal()}) {}
  PriorCost(const Eigen::VectorXd& mean, InverseFactor weight)
      : mean_(mean), weight_(std::move(weight.matrix)) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(mean.size()));
    set_num_residuals(static_cast<int>(mean.size()));
  }
  PriorCost(const double* mean, int size, double sigma)
      : PriorCost(Eigen::Map<const Eigen::VectorXd>(mean, size), Eigen::VectorXd::Constant(size, sigma)) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index size = mean_.size();
    const Eigen::Map<const Eigen::VectorXd> block(parameters[0], size);
    Eigen::Map<Eigen::VectorXd>(residuals, size) = weight_ * (block - mean_);
    if (jacobians && jacobians[0]) Eigen::Map<RowMajor>(jacobians[0], size, size) = weight_;
    return true;
  }

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::VectorXd mean_;
  Eigen::MatrixXd weight_;
};

// Axes of a rotation's sigmas: those of the target frame or of the source frame.
enum class PriorAxes { Target, Source };

// Zero if a rotation equals its prior: r = Log(R R_prior^-1) / sigma about the target's axes, Log(R_prior^-1
// R) / sigma about the source's; without unit. Block: quaternion as in calibration_problem.h.
class RotationPriorCost final : public ceres::SizedCostFunction<3, 4> {
 public:
  RotationPriorCost(const Eigen::Quaterniond& mean, const Eigen::Vector3d& sigma_rad,
                    PriorAxes axes = PriorAxes::Target)
      : mean_(mean), weight_(sigma_rad.cwiseInverse()), axes_(axes) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Quaterniond> rotation(parameters[0]);
    const bool target = axes_ == PriorAxes::Target;
    const Eigen::Vector3d turn =
        quaternionLog(target ? rotation * mean_.conjugate() : mean_.conjugate() * rotation);
    Eigen::Map<Eigen::Vector3d>{residuals} = weight_.cwiseProduct(turn);
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> by_rotation(jacobians[0]);
    by_rotation.leftCols<3>() = weight_.asDiagonal() * so3RightJacobianInverse(turn);
    if (target) by_rotation.leftCols<3>() *= mean_.toRotationMatrix();
    by_rotation.col(3).setZero();
    return true;
  }

 private:
  Eigen::Quaterniond mean_;
  Eigen::Vector3d weight_;
  PriorAxes axes_;
};

// Zero if a translation agrees with its prior along an axis: r = axis . (translation - prior) / sigma,
// without unit. Block: translation [m].
class HeldTranslationCost final : public ceres::SizedCostFunction<1, 3> {
 public:
  HeldTranslationCost(const Eigen::Vector3d& axis, const Eigen::Vector3d& prior_m, double sigma_m)
      : weighted_axis_(axis / sigma_m), prior_m_(prior_m) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = weighted_axis_.dot(Eigen::Map<const Eigen::Vector3d>(parameters[0]) - prior_m_);
    if (jacobians && jacobians[0]) Eigen::Map<Eigen::Vector3d>{jacobians[0]} = weighted_axis_;
    return true;
  }

 private:
  Eigen::Vector3d weighted_axis_, prior_m_;
};

// Zero if a vector has its prior's norm: r = (|block| - norm) / sigma,
// without unit. Block: gravity [m/s^2].
class NormCost final : public ceres::SizedCostFunction<1, 3> {
 public:
  NormCost(double norm, double sigma) : norm_(norm), weight_(1.0 / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> vector(parameters[0]);
    residuals[0] = weight_ * (vector.norm() - norm_);
    if (jacobians && jacobians[0]) Eigen::Map<Eigen::Vector3d>{jacobians[0]} = weight_ * vector.normalized();
    return true;
  }

 private:
  double norm_, weight_;
};

}  // namespace evical
