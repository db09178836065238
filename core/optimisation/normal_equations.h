// The batch's normal equations at the current state: J^T J, J^T r and half of r^T r, accumulated block by
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
  // Keeps its memory where it suffices; entries are undefined.
  void resize(const UnknownColumns& columns);

  BorderedBand matrix;
  Eigen::VectorXd gradient;  // the band's columns, then the border's
  double cost = 0.0;
};

// Overwrites `equations`. Throws Cancelled when asked to stop, as costOf does.
void assemble(const UnknownColumns& columns, int threads, const std::stop_token& stop,
              NormalEquations& equations);

double costOf(const UnknownColumns& columns, int threads, const std::stop_token& stop);

// Sums over the blocks of one part (UnknownColumns::Part): directly in rows of the band to which only this
// part adds, in separate rows if the next part adds to them, too, and separate for the border, to which all
// parts add.
class PartialSums {
 public:
  PartialSums(NormalEquations& equations, Eigen::Index end_row)
      : equations_(equations),
        end_row_(end_row),
        corner_(BorderedBand::RowMajorMatrix::Zero(border(), border())),
        border_gradient_(Eigen::VectorXd::Zero(border())) {}

  // J^T J and J^T r of one block, in its own columns: splines, border, residuals; the lower triangle, row by
  // row.
  void add(const std::vector<Eigen::Index>& spline_columns, const std::vector<Eigen::Index>& border_columns,
           const double* products);

  // Adds the separate rows and the border to the equations; one part after the other.
  void addRest() const;

 private:
  // One row each of the band, of the mixed block, and of the gradient.
  struct Row {
    double *band, *mixed, *gradient;  // band: by column, as BorderedBand::row
  };
  Row row(Eigen::Index row);
  Eigen::Index border() const { return equations_.matrix.borderSize(); }
  Eigen::Index halfBandwidth() const { return equations_.matrix.band().halfBandwidth(); }

  NormalEquations& equations_;
  Eigen::Index end_row_;
  std::vector<Eigen::VectorXd> beside_;  // sums for the rows from end_row_ on: band, border, gradient
  BorderedBand::RowMajorMatrix corner_;  // lower triangle
  Eigen::VectorXd border_gradient_;
  double squares_ = 0.0;
};

}  // namespace evical
