#include "core/optimisation/common_displacement.h"

#include "core/optimisation/optimisation_options.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

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

CommonDisplacement::CommonDisplacement(std::span<const Eigen::Matrix2d> roots)
    : roots_(2 * static_cast<Eigen::Index>(roots.size()), 2) {
  for (std::size_t i = 0; i < roots.size(); ++i)
    roots_.middleRows<2>(2 * static_cast<Eigen::Index>(i)) = roots[i];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(Eigen::Matrix2d(roots_.transpose() * roots_));
  const Eigen::Vector2d gains = eigen.eigenvalues().unaryExpr(&gainOf);
  by_sums_ = roots_ * (eigen.eigenvectors() * gains.asDiagonal() * eigen.eigenvectors().transpose());
}

// Some columns at once, for sums on the stack.
void CommonDisplacement::whiten(double* matrix, Eigen::Index columns) const {
  constexpr Eigen::Index kAtOnce = 16;
  using Rows = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
                          Eigen::OuterStride<>>;
  for (Eigen::Index first = 0; first < columns; first += kAtOnce) {
    const Eigen::Index count = std::min(kAtOnce, columns - first);
    Rows rows(matrix + first, roots_.rows(), count, Eigen::OuterStride<>(columns));
    Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor, 2, kAtOnce> sums(2, count);
    sums.setZero();
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      sums.row(0) += roots_(k, 0) * rows.row(k);
      sums.row(1) += roots_(k, 1) * rows.row(k);
    }
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
      rows.row(k) += by_sums_(k, 0) * sums.row(0) + by_sums_(k, 1) * sums.row(1);
  }
}

}  // namespace evical
