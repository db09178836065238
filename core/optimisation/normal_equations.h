// The batch's normal equations at the state that its unknowns hold: J^T J, J^T r and half of r^T r, added up block by
// block. Sums are the same for any number of threads.
#pragma once

#include "core/numerics/bordered_band.h"
#include "core/optimisation/block_jacobian.h"
#include "core/optimisation/unknown_columns.h"

#include <Eigen/Core>

#include <stop_token>
#include <vector>

namespace evical {

struct NormalEquations {
  NormalEquations(Eigen::Index splines, Eigen::Index half_bandwidth, Eigen::Index border)
      : matrix(splines, half_bandwidth, border), gradient(Eigen::VectorXd::Zero(splines + border)) {}
  explicit NormalEquations(const UnknownColumns& columns)
      : NormalEquations(columns.splineSize(), columns.halfBandwidth(), columns.borderSize()) {}

  void setZero();

  BorderedBand matrix;
  Eigen::VectorXd gradient;  // by the band's columns, then by the border's
  double cost = 0.0;
};

// Overwrites `equations`. Throws Cancelled when asked to stop, as costOf does.
void assemble(const UnknownColumns& columns, int threads, const std::stop_token& stop,
              NormalEquations& equations);

double costOf(const UnknownColumns& columns, int threads, const std::stop_token& stop);

// What the blocks of one part sum up to (UnknownColumns::Part): in the equations' own rows of the band where no other
// part adds to them, beside them where the next one does, and for the border, to which all add.
class PartialSums {
 public:
  PartialSums(NormalEquations& equations, Eigen::Index end_row)
      : equations_(equations),
        end_row_(end_row),
        corner_(BorderedBand::RowMajorMatrix::Zero(border(), border())),
        border_gradient_(Eigen::VectorXd::Zero(border())) {}

  // J^T J and J^T r of one block, in its own columns: splines, border, residuals; the lower triangle, row by row.
  void add(const std::vector<Eigen::Index>& spline_columns, const std::vector<Eigen::Index>& border_columns,
           const double* products);

  // To the equations; one part after the other.
  void addRest() const;

 private:
  // A row of the band, of what stands beside it, and of the gradient.
  struct Row {
    double *band, *mixed, *gradient;  // band: by column, as BorderedBand::row
  };
  Row row(Eigen::Index row);
  Eigen::Index border() const { return equations_.matrix.borderSize(); }
  Eigen::Index halfBandwidth() const { return equations_.matrix.band().halfBandwidth(); }

  NormalEquations& equations_;
  Eigen::Index end_row_;
  std::vector<Eigen::VectorXd> beside_;  // rows from end_row_ on: band, border, gradient
  BorderedBand::RowMajorMatrix corner_;  // lower triangle
  Eigen::VectorXd border_gradient_;
  double squares_ = 0.0;
};

// The lower triangle of R^T R, row by row, R being `rows` rows of `columns` numbers.
void lowerProducts(const double* r, Eigen::Index rows, Eigen::Index columns, std::vector<double>& products);

}  // namespace evical
