#include "core/numerics/band_cholesky.h"

#include <cmath>

namespace evical {
namespace {

constexpr double kNothingLeft =
    1e-13;  // relative to the diagonal before elimination: rounding, not information
constexpr double kHugePivot = 1e100;  // makes the direction's solution 0

double dotOf(const double* a, const double* b, Eigen::Index begin, Eigen::Index end) {
  using Map = Eigen::Map<const Eigen::VectorXd>;
  return Map(a + begin, end - begin).dot(Map(b + begin, end - begin));
}

}  // namespace

BandCholesky::BandCholesky(Eigen::Index size, Eigen::Index half_bandwidth)
    : size_(size),
      half_bandwidth_(half_bandwidth),
      band_(static_cast<std::size_t>(size * (half_bandwidth + 1)), 0.0) {}

void BandCholesky::resize(Eigen::Index size, Eigen::Index half_bandwidth) {
  size_ = size;
  half_bandwidth_ = half_bandwidth;
  band_.resize(static_cast<std::size_t>(size * (half_bandwidth + 1)));
}

void BandCholesky::addOuter(Eigen::Index first, const Eigen::Ref<const Eigen::VectorXd>& weights,
                            double scale) {
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) add(first + i, first + j, scale * weights(i) * weights(j));
  }
}

bool BandCholesky::factorise() {
  bool positive = true;
  for (Eigen::Index row = 0; row < size_; ++row) positive = factoriseRow(row) && positive;
  return positive;
}

bool BandCholesky::factoriseRow(Eigen::Index row) {
  return factoriseRow(row, 0.0, kNothingLeft);
}

bool BandCholesky::factoriseRow(Eigen::Index index, double added, double min_share) {
  double* const of_row = row(index);
  const Eigen::Index first = firstOf(index);
  for (Eigen::Index col = first; col < index; ++col) {
    const double* const of_col = row(col);
    of_row[col] = (of_row[col] - dotOf(of_row, of_col, first, col)) / of_col[col];
  }
  const double diagonal = of_row[index] + added;
  const double pivot = diagonal - dotOf(of_row, of_row, first, index);
  const bool known = pivot > min_share * diagonal && std::isfinite(pivot);
  of_row[index] = known ? std::sqrt(pivot) : kHugePivot;
  return known;
}

void BandCholesky::solveInPlace(Eigen::Ref<Eigen::MatrixXd> right) const {
  for (Eigen::Index col = 0; col < right.cols(); ++col) {
    double* x = right.col(col).data();
    for (Eigen::Index index = 0; index < size_; ++index) {
      const double* const of_row = row(index);
      x[index] = (x[index] - dotOf(of_row, x, firstOf(index), index)) / of_row[index];
    }
    solveTransposed(x);
  }
}

void BandCholesky::solveInPlace(RowMajorMatrix& right) const {
  for (Eigen::Index index = 0; index < size_; ++index) {
    const double* const of_row = row(index);
    auto to = right.row(index);
    for (Eigen::Index col = firstOf(index); col < index; ++col) to -= of_row[col] * right.row(col);
    to /= of_row[index];
  }
  for (Eigen::Index index = size_ - 1; index >= 0; --index) {
    const double* const of_row = row(index);
    right.row(index) /= of_row[index];
    for (Eigen::Index col = firstOf(index); col < index; ++col)
      right.row(col) -= of_row[col] * right.row(index);
  }
}

void BandCholesky::correlateInPlace(Eigen::VectorXd& white) const {
  solveTransposed(white.data());
}

void BandCholesky::solveTransposed(double* x) const {
  for (Eigen::Index index = size_ - 1; index >= 0; --index) {
    const double* const of_row = row(index);
    x[index] /= of_row[index];
    for (Eigen::Index col = firstOf(index); col < index; ++col) x[col] -= of_row[col] * x[index];
  }
}

}  // namespace evical
