#include "core/optimisation/common_displacement.h"

#include "core/optimisation/model_options.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

// (1 / sqrt(1 + l) - 1) / l, also for small l.
double gainOf(double l) {
  const double root = std::sqrt(1.0 + std::max(0.0, l));
  return -1.0 / (root * (1.0 + root));
}

}  // namespace

double commonDisplacement_px(CameraKind kind, const CircleObservation& circle, const ModelOptions& options) {
  if (kind != CameraKind::Events) return 0.0;
  const double speed_px_s = std::max(options.common_displacement_px_s, circle.velocity_px_s.norm());
  return std::hypot(options.common_displacement_px, options.common_displacement_px2_s / speed_px_s);
}

CommonDisplacement::CommonDisplacement(std::vector<Eigen::Index> rows, std::span<const Eigen::Matrix2d> roots)
    : rows_(std::move(rows)), roots_(2 * static_cast<Eigen::Index>(roots.size()), 2) {
  for (std::size_t i = 0; i < roots.size(); ++i)
    roots_.middleRows<2>(2 * static_cast<Eigen::Index>(i)) = roots[i];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(Eigen::Matrix2d(roots_.transpose() * roots_));
  const Eigen::Vector2d gains = eigen.eigenvalues().unaryExpr(&gainOf);
  by_sums_ = roots_ * (eigen.eigenvectors() * gains.asDiagonal() * eigen.eigenvectors().transpose());
}

void CommonDisplacement::whiten(double* matrix, Eigen::Index columns) const {
  for (Eigen::Index col = 0; col < columns; ++col) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto k = 2 * static_cast<Eigen::Index>(i);
      const double* const at = matrix + rows_[i] * columns + col;
      sum += at[0] * roots_.row(k).transpose() + at[columns] * roots_.row(k + 1).transpose();
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto k = 2 * static_cast<Eigen::Index>(i);
      double* const at = matrix + rows_[i] * columns + col;
      at[0] += by_sums_.row(k).dot(sum);
      at[columns] += by_sums_.row(k + 1).dot(sum);
    }
  }
}

}  // namespace evical
