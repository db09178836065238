// Zero when a block has its prior's mean: r = (block - mean) / sigma, without unit. Block: up to six numbers.
#pragma once

#include <ceres/cost_function.h>

#include <array>

namespace evical {

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

}  // namespace evical
