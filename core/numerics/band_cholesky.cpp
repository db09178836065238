#include "core/numerics/band_cholesky.h"

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

void BandCholesky::addOuter(Eigen::Index first, const Eigen::Ref<const Eigen::VectorXd>& weights,
                            double scale) {
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) add(first + i, first + j, scale * weights(i) * weights(j));
  }
}

bool BandCholesky::factorise() {
  bool positive = true;
  for (Eigen::Index row = 0; row < size_; ++row) {
    const Eigen::Index first = std::max<Eigen::Index>(0, row - half_bandwidth_);
    const double* of_row = band_.data() + index(row, 0);
    for (Eigen::Index col = first; col < row; ++col) {
      const double* of_col = band_.data() + index(col, 0);
      double sum = at(row, col);
      for (Eigen::Index k = col - 1; k >= first; --k) sum -= of_row[k] * of_col[k];
      at(row, col) = sum / at(col, col);
    }
    const double diagonal = at(row, row);
    double pivot = diagonal;
    for (Eigen::Index k = row - 1; k >= first; --k) pivot -= of_row[k] * of_row[k];
    const bool known = pivot > kNothingLeft * diagonal;
    at(row, row) = known ? std::sqrt(pivot) : kHugePivot;
    positive = positive && known;
  }
  return positive;
}

void BandCholesky::solveInPlace(Eigen::Ref<Eigen::MatrixXd> right) const {
  for (Eigen::Index col = 0; col < right.cols(); ++col) {
    double* x = right.col(col).data();
    for (Eigen::Index row = 0; row < size_; ++row) {
      double sum = x[row];
      for (Eigen::Index k = row - 1; k >= std::max<Eigen::Index>(0, row - half_bandwidth_); --k)
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
  for (Eigen::Index col = size_ - 1; col >= 0; --col) {
    double sum = x[col];
    const Eigen::Index end = std::min(size_, col + half_bandwidth_ + 1);
    for (Eigen::Index row = col + 1; row < end; ++row) sum -= at(row, col) * x[row];
    x[col] = sum / at(col, col);
  }
}

}  // namespace evical
