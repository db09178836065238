#include "core/optimisation/band_cholesky.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kNothingLeft = 1e-13;  // of the diagonal before elimination: rounding, not information
constexpr double kHugePivot = 1e100;    // makes the direction's solution 0

}  // namespace

BandCholesky::BandCholesky(Eigen::Index size, Eigen::Index half_bandwidth)
    : size_(size),
      half_bandwidth_(half_bandwidth),
      band_(static_cast<std::size_t>(size * (half_bandwidth + 1)), 0.0) {}

void BandCholesky::factorise() {
  for (Eigen::Index row = 0; row < size_; ++row) {
    const Eigen::Index first = std::max<Eigen::Index>(0, row - half_bandwidth_);
    const double diagonal = at(row, row);
    double pivot = diagonal;
    for (Eigen::Index col = first; col < row; ++col) {
      const Eigen::Index from = std::max(first, col - half_bandwidth_);
      double sum = at(row, col);
      const double* a = band_.data() + index(row, from);
      const double* b = band_.data() + index(col, from);
      for (Eigen::Index k = 0; k < col - from; ++k) sum -= a[k] * b[k];
      at(row, col) = sum / at(col, col);
      pivot -= at(row, col) * at(row, col);
    }
    at(row, row) = pivot > kNothingLeft * diagonal ? std::sqrt(pivot) : kHugePivot;
  }
}

void BandCholesky::solveInPlace(Eigen::MatrixXd& right) const {
  for (Eigen::Index col = 0; col < right.cols(); ++col) {
    double* x = right.col(col).data();
    for (Eigen::Index row = 0; row < size_; ++row) {
      double sum = x[row];
      for (Eigen::Index k = std::max<Eigen::Index>(0, row - half_bandwidth_); k < row; ++k)
        sum -= at(row, k) * x[k];
      x[row] = sum / at(row, row);
    }
    solveTransposed(x);
  }
}

void BandCholesky::correlateInPlace(Eigen::VectorXd& white) const {
  solveTransposed(white.data());
}

void BandCholesky::solveTransposed(double* x) const {
  for (Eigen::Index row = size_ - 1; row >= 0; --row) {
    x[row] /= at(row, row);
    for (Eigen::Index k = std::max<Eigen::Index>(0, row - half_bandwidth_); k < row; ++k)
      x[k] -= at(row, k) * x[row];
  }
}

}  // namespace evical
