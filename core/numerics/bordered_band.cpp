#include "core/numerics/bordered_band.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace evical {
namespace {

using Eigen::Index;

// Rows of L^-1 times a matrix, as many as the next rows need, and the sum of their outer products.
class EliminatedRows {
 public:
  EliminatedRows(Index half_bandwidth, Index columns)
      : half_bandwidth_(half_bandwidth),
        rows_(BorderedBand::RowMajorMatrix::Zero(half_bandwidth + kPanel, columns)),
        products_(Eigen::MatrixXd::Zero(columns, columns)) {}

  // The next row: set it to the matrix's row, then eliminate it with the factor's.
  double* next() { return row(0); }

  void eliminate(const BandCholesky& factor, Index index) {
    const double* const of_row = factor.row(index);
    double* const to = next();
    const Index columns = rows_.cols();
    for (Index col = factor.firstOf(index); col < index; ++col) {
      const double* const other = row(col - index);
      const double by = of_row[col];
      for (Index k = 0; k < columns; ++k) to[k] -= by * other[k];
    }
    const double inverse = 1.0 / of_row[index];
    for (Index k = 0; k < columns; ++k) to[k] *= inverse;
    if (++count_ == kPanel) sumUp();
  }

  // Product with its own transpose; the lower triangle.
  const Eigen::MatrixXd& products() {
    sumUp();
    return products_;
  }

 private:
  static constexpr Index kPanel = 64;

  double* row(Index from_next) {
    return rows_.data() + (half_bandwidth_ + count_ + from_next) * rows_.cols();
  }

  void sumUp() {
    if (count_ == 0) return;
    products_.selfadjointView<Eigen::Lower>().rankUpdate(
        rows_.middleRows(half_bandwidth_, count_).transpose());
    std::copy_n(rows_.data() + count_ * rows_.cols(), half_bandwidth_ * rows_.cols(), rows_.data());
    count_ = 0;
  }

  Index half_bandwidth_, count_ = 0;
  BorderedBand::RowMajorMatrix rows_;  // the last rows of the panel before, then those of this panel
  Eigen::MatrixXd products_;
};

}  // namespace

void BorderedBand::setZero() {
  band_.setZero();
  mixed_.setZero();
  corner_.setZero();
}

Eigen::VectorXd BorderedBand::diagonal() const {
  Eigen::VectorXd diagonal(size());
  for (Index i = 0; i < band_.size(); ++i) diagonal[i] = band_.row(i)[i];
  diagonal.tail(borderSize()) = corner_.diagonal();
  return diagonal;
}

std::optional<Eigen::VectorXd> BorderedBand::solve(const Eigen::VectorXd& added, const Eigen::VectorXd& right,
                                                   BandCholesky& factor) const {
  const Index border = borderSize();
  factor = band_;
  EliminatedRows rows(band_.halfBandwidth(), border + 1);
  for (Index index = 0; index < band_.size(); ++index) {
    if (!factor.factoriseRow(index, added[index], 0.0)) return std::nullopt;
    double* const next = rows.next();
    std::copy_n(mixed_.data() + index * border, border, next);
    next[border] = right[index];
    rows.eliminate(factor, index);
  }
  const Eigen::MatrixXd& taken = rows.products();
  Eigen::VectorXd solution(size());
  Eigen::VectorXd in_band = right.head(band_.size());
  if (border > 0) {
    Eigen::MatrixXd left = corner_ - taken.topLeftCorner(border, border);
    left.diagonal() += added.tail(border);
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> solver(left);
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Eigen::VectorXd right_left = right.tail(border) - taken.row(border).head(border).transpose();
    solution.tail(border) = solver.solve(right_left);
    in_band.noalias() -= mixed_ * solution.tail(border);
  }
  factor.solveInPlace(in_band);
  solution.head(band_.size()) = in_band;
  return solution;
}

Eigen::MatrixXd BorderedBand::schurComplement() const {
  BandCholesky factor = band_;
  EliminatedRows rows(band_.halfBandwidth(), borderSize());
  for (Index index = 0; index < band_.size(); ++index) {
    factor.factoriseRow(index);
    std::copy_n(mixed_.data() + index * borderSize(), borderSize(), rows.next());
    rows.eliminate(factor, index);
  }
  Eigen::MatrixXd left = corner_ - rows.products();
  left.triangularView<Eigen::StrictlyUpper>() = left.transpose();
  return left;
}

}  // namespace evical
