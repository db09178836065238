// Costs of what is known beforehand.
#pragma once

#include "core/geometry/so3.h"
#include "core/optimisation/inertial_cost.h"
#include "core/optimisation/jacobian_rows.h"

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

// Zero when a rotation is none: r = 2 sin(angle / 2) axis / sigma, without unit. Block: rotation (x y z w).
class RotationPriorCost final : public ceres::SizedCostFunction<3, 4> {
 public:
  explicit RotationPriorCost(double sigma_rad) : weight_(2.0 / sigma_rad) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Quaterniond> rotation(parameters[0]);
    const double weight = rotation.w() < 0.0 ? -weight_ : weight_;
    Eigen::Map<Eigen::Vector3d>{residuals} = weight * rotation.vec();
    if (jacobians && jacobians[0]) {
      const Eigen::Matrix3d by_half =
          rotation.w() * Eigen::Matrix3d::Identity() + skew(Eigen::Vector3d(rotation.vec()));
      writeRotationRows<3>(jacobians, 0, 0, Eigen::Matrix3d(0.5 * weight * by_half));
    }
    return true;
  }

 private:
  double weight_;
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
