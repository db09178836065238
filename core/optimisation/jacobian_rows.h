// Position of a measurement's rows in Ceres' row-major Jacobian blocks, as a cost function writes them.
#pragma once

#include <Eigen/Core>

namespace evical {

template <int Rows, int Columns>
auto jacobianRows(double** jacobians, int block, Eigen::Index first_row) {
  constexpr int kOrder = Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor;
  return Eigen::Map<Eigen::Matrix<double, Rows, Columns, kOrder>>(jacobians[block] + first_row * Columns);
}

// A quaternion block, so3_manifold.h: the last of the four columns is unused.
template <int Rows>
void writeRotationRows(double** jacobians, int block, Eigen::Index first_row,
                       const Eigen::Matrix<double, Rows, 3>& by_delta) {
  auto rows = jacobianRows<Rows, 4>(jacobians, block, first_row);
  rows.template leftCols<3>() = by_delta;
  rows.col(3).setZero();
}

}  // namespace evical
