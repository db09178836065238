// Columns of a built problem's unknowns in its normal equations: control points in order of time, which form
// a band (core/numerics/bordered_band.h), and as its border the calibrated quantities and then the biases'
// knots.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace ceres {
class CostFunction;
class Manifold;
}  // namespace ceres

namespace evical {

class CalibrationProblem;
class ViewCost;

// One parameter block.
struct Unknown {
  double* values = nullptr;
  int size = 0;
  int columns = 0;                            // of its tangent space; 0: fixed
  bool spline = false;                        // in the band, otherwise in the border
  Eigen::Index first = 0;                     // column in the band or the border
  const ceres::Manifold* manifold = nullptr;  // null if its numbers are its tangent space
  bool leading = true;  // derivatives by the tangent are the first of those by the numbers
  std::vector<double> lower = {}, upper = {};  // bounds of its numbers; empty without any
};

class UnknownColumns {
 public:
  // Columns of the problem in its current state.
  explicit UnknownColumns(CalibrationProblem& problem);

  Eigen::Index splineSize() const { return spline_size_; }
  Eigen::Index quantitySize() const { return first_column_.back(); }
  Eigen::Index driftSize() const { return drift_size_; }  // columns after the quantities'
  Eigen::Index borderSize() const { return quantitySize() + drift_size_; }
  Eigen::Index size() const { return splineSize() + borderSize(); }
  Eigen::Index halfBandwidth() const { return half_bandwidth_; }
  // First column of each quantity within the border, plus the end.
  const std::vector<Eigen::Index>& firstColumn() const { return first_column_; }

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  // Column of unknown k's tangent space among all columns: the band's, then the border's.
  Eigen::Index firstOf(const Unknown& unknown) const {
    return unknown.spline ? unknown.first : spline_size_ + unknown.first;
  }

  // Residual blocks as in CalibrationProblem::blocks().
  std::size_t blockCount() const { return blocks_.size(); }
  const ceres::CostFunction& cost(std::size_t block) const { return *blocks_[block].cost; }
  const ViewCost* view(std::size_t block) const { return blocks_[block].view; }  // null if it is another cost
  // Indices into unknowns(), in the order of the cost function's blocks.
  std::span<const std::int32_t> unknownsOf(std::size_t block) const;

  // Residual blocks in order of time, in parts that are the same for any number of threads. Only this part's
  // blocks add to rows of the band from first_row to end_row, except that earlier parts reach across its
  // begin.
  struct Part {
    std::size_t begin, end;  // of order()
    Eigen::Index first_row, end_row;
  };
  const std::vector<std::size_t>& order() const { return order_; }
  const std::vector<Part>& parts() const { return parts_; }

 private:
  struct Block {
    const ceres::CostFunction* cost;
    const ViewCost* view;
    std::size_t begin, end;                           // of unknown_indices_
    Eigen::Index first_column = 0, last_column = -1;  // of the band
  };

  void addUnknowns(CalibrationProblem& problem);
  void addBlocks(CalibrationProblem& problem);
  void makeParts();

  std::vector<Unknown> unknowns_;
  std::vector<Block> blocks_;
  std::vector<std::int32_t> unknown_indices_;
  std::vector<Eigen::Index> first_column_;
  Eigen::Index spline_size_ = 0, drift_size_ = 0, half_bandwidth_ = 0;
  std::vector<std::size_t> order_;
  std::vector<Part> parts_;
};

// The numbers of all free unknowns, concatenated.
class UnknownNumbers {
 public:
  explicit UnknownNumbers(const UnknownColumns& columns) : columns_(columns) {}

  Eigen::VectorXd read() const;
  void write(const Eigen::VectorXd& numbers) const;
  // Applies a step in the tangent space, within the bounds.
  void writeMoved(const Eigen::VectorXd& numbers, const Eigen::VectorXd& step) const;

 private:
  const UnknownColumns& columns_;
};

}  // namespace evical
