// Costs of what is known beforehand.
#pragma once

#include "core/optimisation/inertial_cost.h"

#include <ceres/sized_cost_function.h>
#include <Eigen/Core>

#include <array>

namespace evical {

// Zero when a block has its prior's mean: r = (block - mean) / sigma, without unit. Block: up to six numbers.
class PriorCost final : public ceres::CostFunction {
 public:
  PriorCost(const double* mean, int size, double sigma) : weight_(1.0 / sigma), size_(size) {
    for (int i = 0; i < size; ++i) mean_[static_cast<std::size_t>(i)] = mean[i];
    mutable_parameter_block_sizes()->push_back(size);
    set_num_residuals(size);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    for (int i = 0; i < size_; ++i) {
      residuals[i] = weight_ * (parameters[0][i] - mean_[static_cast<std::size_t>(i)]);
      if (!jacobians || !jacobians[0]) continue;
      for (int j = 0; j < size_; ++j) jacobians[0][i * size_ + j] = i == j ? weight_ : 0.0;
    }
    return true;
  }

 private:
  double weight_;
  int size_;
  std::array<double, 6> mean_ = {};
};

// Zero when a camera's intrinsics have their priors' means: r = (block - mean) / sigma, without unit. Block:
// fx fy cx cy d0..d4.
class IntrinsicsPriorCost final : public ceres::SizedCostFunction<9, 9> {
 public:
  IntrinsicsPriorCost(const std::array<double, 9>& mean, const std::array<double, 9>& sigma)
      : mean_(mean.data()), weight_(Vector(sigma.data()).cwiseInverse()) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Map<Vector>{residuals} = weight_.cwiseProduct(Eigen::Map<const Vector>(parameters[0]) - mean_);
    if (jacobians && jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> by_block(jacobians[0]);
      by_block = weight_.asDiagonal();
    }
    return true;
  }

 private:
  using Vector = Eigen::Matrix<double, 9, 1>;
  Vector mean_, weight_;
};

// Zero when an IMU's mapping leaves an axis as it is: r = (M axis - axis) / sigma, without unit. Block:
// mapping.
class HeldAxisCost final : public ceres::SizedCostFunction<3, 6> {
 public:
  HeldAxisCost(const Eigen::Vector3d& axis, double sigma) : axis_(axis), weight_(1.0 / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::Vector3d> error(residuals);
    error = weight_ * (mappingFromParameters(parameters[0]) * axis_ - axis_);
    if (jacobians && jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> by_mapping(jacobians[0]);
      by_mapping = weight_ * derivativeByMapping(axis_);
    }
    return true;
  }

 private:
  Eigen::Vector3d axis_;
  double weight_;
};

// Zero when a translation has nothing along an axis: r = axis . translation / sigma, without unit. Block:
// translation [m].
class HeldTranslationCost final : public ceres::SizedCostFunction<1, 3> {
 public:
  HeldTranslationCost(const Eigen::Vector3d& axis, double sigma_m) : weighted_axis_(axis / sigma_m) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = weighted_axis_.dot(Eigen::Map<const Eigen::Vector3d>(parameters[0]));
    if (jacobians && jacobians[0]) Eigen::Map<Eigen::Vector3d>{jacobians[0]} = weighted_axis_;
    return true;
  }

 private:
  Eigen::Vector3d weighted_axis_;
};

}  // namespace evical
