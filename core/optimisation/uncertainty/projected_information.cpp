#include "core/optimisation/uncertainty/projected_information.h"

#include "core/numerics/band_cholesky.h"
#include "core/optimisation/calibration_problem.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <unordered_map>

namespace evical {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Where a block's tangent columns go.
struct Columns {
  bool spline = false;
  Eigen::Index first = 0;
  int size = 0;
};

// The dense Jacobian of one residual block, in tangent columns: those of splines first.
struct BlockJacobian {
  Eigen::VectorXd residuals;
  RowMajorMatrix jacobian;
  std::vector<Eigen::Index> spline_columns, quantity_columns;

  auto bySpline() const { return jacobian.leftCols(static_cast<Eigen::Index>(spline_columns.size())); }
  auto byQuantities() const { return jacobian.rightCols(static_cast<Eigen::Index>(quantity_columns.size())); }
};

class Layout {
 public:
  Layout(CalibrationProblem& problem, const RunContext& context) : problem_(problem), context_(context) {
    for (double* block : problem.splineBlocks()) {
      columns_[block] = {true, spline_size_, problem.problem().ParameterBlockTangentSize(block)};
      spline_size_ += problem.problem().ParameterBlockTangentSize(block);
    }
    for (const Quantity& quantity : problem.quantities()) {
      first_column_.push_back(quantity_size_);
      columns_[quantity.block] = {false, quantity_size_,
                                  problem.problem().ParameterBlockTangentSize(quantity.block)};
      quantity_size_ += problem.problem().ParameterBlockTangentSize(quantity.block);
    }
    first_column_.push_back(quantity_size_);
    for (const Quantity& knot : problem.driftBlocks()) {
      const int size = problem.problem().ParameterBlockTangentSize(knot.block);
      columns_[knot.block] = {false, quantity_size_ + drift_size_, size};
      drift_size_ += size;
    }
  }

  Eigen::Index splineSize() const { return spline_size_; }
  Eigen::Index quantitySize() const { return quantity_size_; }
  Eigen::Index driftSize() const { return drift_size_; }  // columns after the quantities'
  const std::vector<Eigen::Index>& firstColumn() const { return first_column_; }

  Eigen::Index halfBandwidth() const {
    Eigen::Index widest = 0;
    for (const BlockInfo& info : problem_.blocks()) {
      Eigen::Index low = std::numeric_limits<Eigen::Index>::max(), high = 0;
      for (double* block : blocksOf(info)) {
        const auto found = columns_.find(block);
        if (found == columns_.end() || !found->second.spline) continue;
        low = std::min(low, found->second.first);
        high = std::max(high, found->second.first + found->second.size - 1);
      }
      if (low <= high) widest = std::max(widest, high - low);
    }
    return widest;
  }

  void evaluate(const BlockInfo& info, BlockJacobian& out) const;

 private:
  std::vector<double*> blocksOf(const BlockInfo& info) const {
    std::vector<double*> blocks;
    problem_.problem().GetParameterBlocksForResidualBlock(info.id, &blocks);
    return blocks;
  }

  CalibrationProblem& problem_;
  const RunContext& context_;
  std::unordered_map<double*, Columns> columns_;
  std::vector<Eigen::Index> first_column_;
  Eigen::Index spline_size_ = 0, quantity_size_ = 0, drift_size_ = 0;
};

void Layout::evaluate(const BlockInfo& info, BlockJacobian& out) const {
  context_.throwIfStopped();
  const ceres::CostFunction& cost = *problem_.problem().GetCostFunctionForResidualBlock(info.id);
  const std::vector<double*> blocks = blocksOf(info);
  std::vector<RowMajorMatrix> ambient(blocks.size());
  std::vector<double*> jacobians(blocks.size(), nullptr);
  out.spline_columns.clear();
  out.quantity_columns.clear();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto found = columns_.find(blocks[i]);
    if (found == columns_.end()) continue;  // held constant
    ambient[i].resize(cost.num_residuals(), cost.parameter_block_sizes()[i]);
    jacobians[i] = ambient[i].data();
    auto& list = found->second.spline ? out.spline_columns : out.quantity_columns;
    for (int k = 0; k < found->second.size; ++k) list.push_back(found->second.first + k);
  }
  out.residuals.resize(cost.num_residuals());
  cost.Evaluate(blocks.data(), out.residuals.data(), jacobians.data());
  out.jacobian.resize(cost.num_residuals(),
                      static_cast<Eigen::Index>(out.spline_columns.size() + out.quantity_columns.size()));
  Eigen::Index spline_at = 0, quantity_at = static_cast<Eigen::Index>(out.spline_columns.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!jacobians[i]) continue;
    const Columns& columns = columns_.at(blocks[i]);
    Eigen::Index& at = columns.spline ? spline_at : quantity_at;
    const ceres::Manifold* manifold = problem_.problem().GetManifold(blocks[i]);
    auto target = out.jacobian.middleCols(at, columns.size);
    if (manifold) {
      RowMajorMatrix plus(manifold->AmbientSize(), manifold->TangentSize());
      manifold->PlusJacobian(blocks[i], plus.data());
      target.noalias() = ambient[i] * plus;
    } else {
      target = ambient[i];
    }
    at += columns.size;
  }
}

// Sums of the normal equations, splines and then the biases' knots eliminated.
class Elimination {
 public:
  Elimination(const CalibrationProblem& problem, const Layout& layout)
      : problem_(problem),
        layout_(layout),
        splines_(layout.splineSize(), layout.halfBandwidth()),
        eliminated_(Eigen::MatrixXd::Zero(layout.splineSize(), layout.quantitySize() + layout.driftSize())) {}

  void eliminate() {
    BlockJacobian block;
    for (const BlockInfo& info : problem_.blocks()) {
      layout_.evaluate(info, block);
      const Eigen::MatrixXd splines = block.bySpline().transpose() * block.bySpline();
      const Eigen::MatrixXd mixed = block.bySpline().transpose() * block.byQuantities();
      for (std::size_t a = 0; a < block.spline_columns.size(); ++a) {
        const Eigen::Index row = block.spline_columns[a];
        for (std::size_t b = 0; b < block.spline_columns.size(); ++b) {
          if (block.spline_columns[b] > row) continue;
          splines_.add(row, block.spline_columns[b],
                       splines(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
        }
        for (std::size_t q = 0; q < block.quantity_columns.size(); ++q) {
          eliminated_(row, block.quantity_columns[q]) +=
              mixed(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(q));
        }
      }
    }
    splines_.factorise();
    splines_.solveInPlace(eliminated_);
    if (layout_.driftSize() > 0) eliminateDrift();
  }

  // P of one block, all quantities.
  Eigen::MatrixXd project(const BlockJacobian& block) const {
    const Eigen::Index size = layout_.quantitySize();
    Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(block.residuals.size(), eliminated_.cols());
    for (std::size_t q = 0; q < block.quantity_columns.size(); ++q) {
      const Eigen::Index column = block.quantity_columns[q];
      const auto by_column = block.byQuantities().col(static_cast<Eigen::Index>(q));
      if (column < eliminated_.cols()) {
        projected.col(column) = by_column;
      } else {
        projected.noalias() -= by_column * drift_by_quantities_.row(column - size);
      }
    }
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(block.spline_columns.size()), eliminated_.cols());
    for (std::size_t a = 0; a < block.spline_columns.size(); ++a) {
      rows.row(static_cast<Eigen::Index>(a)) = eliminated_.row(block.spline_columns[a]);
    }
    projected.noalias() -= block.bySpline() * rows;
    return projected;
  }

  const BandCholesky& splines() const { return splines_; }
  const Eigen::MatrixXd& driftByQuantities() const { return drift_by_quantities_; }
  const Eigen::MatrixXd& driftCovariance() const { return drift_covariance_; }

 private:
  // From rows of the knots' own Schur complement, since few blocks have knots.
  void eliminateDrift() {
    const Eigen::Index size = layout_.quantitySize(), knots = layout_.driftSize();
    Eigen::MatrixXd schur = Eigen::MatrixXd::Zero(knots, size + knots);
    BlockJacobian block;
    for (const BlockInfo& info : problem_.blocks()) {
      layout_.evaluate(info, block);
      if (block.quantity_columns.empty() || block.quantity_columns.back() < size) continue;
      const Eigen::MatrixXd projected = project(block);
      for (std::size_t q = 0; q < block.quantity_columns.size(); ++q) {
        const Eigen::Index knot = block.quantity_columns[q] - size;
        if (knot < 0) continue;
        schur.row(knot).noalias() +=
            block.byQuantities().col(static_cast<Eigen::Index>(q)).transpose() * projected;
      }
    }
    const Eigen::LDLT<Eigen::MatrixXd> solver(schur.rightCols(knots));
    drift_covariance_ = solver.solve(Eigen::MatrixXd::Identity(knots, knots));
    drift_by_quantities_ = solver.solve(schur.leftCols(size));
    const Eigen::MatrixXd kept =
        eliminated_.leftCols(size) - eliminated_.rightCols(knots) * drift_by_quantities_;
    eliminated_ = kept;
  }

  const CalibrationProblem& problem_;
  const Layout& layout_;
  BandCholesky splines_;
  Eigen::MatrixXd eliminated_;  // (J_x^T J_x)^-1 J_x^T J_q; until they are eliminated, knots' columns follow
  Eigen::MatrixXd drift_by_quantities_, drift_covariance_;
};

std::size_t groupOf(std::vector<MeasurementGroup>& groups, const BlockInfo& info, Eigen::Index size) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i].kind == info.kind && groups[i].sensor == info.sensor) return i;
  }
  MeasurementGroup group;
  group.kind = info.kind;
  group.sensor = info.sensor;
  group.information = Eigen::MatrixXd::Zero(size, size);
  groups.push_back(std::move(group));
  return groups.size() - 1;
}

// How many residuals of each group the splines absorb: trace of J_x (J_x^T J_x)^-1 J_x^T over the group's
// rows, by random signs (Hutchinson 1990). The few quantities themselves don't matter.
void countAbsorbed(const CalibrationProblem& problem, const Layout& layout, const Elimination& elimination,
                   std::vector<MeasurementGroup>& groups) {
  constexpr std::uint64_t kSeed = 20260101;  // any: the count is good to a fraction of a percent
  std::mt19937_64 random(kSeed);
  const auto group_count = static_cast<Eigen::Index>(groups.size());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(layout.splineSize(), group_count);
  BlockJacobian block;
  for (const BlockInfo& info : problem.blocks()) {
    layout.evaluate(info, block);
    const auto group = static_cast<Eigen::Index>(groupOf(groups, info, layout.quantitySize()));
    Eigen::VectorXd signs(block.residuals.size());
    for (Eigen::Index i = 0; i < signs.size(); ++i) signs[i] = (random() & 1U) ? 1.0 : -1.0;
    const Eigen::VectorXd sum = block.bySpline().transpose() * signs;
    for (std::size_t a = 0; a < block.spline_columns.size(); ++a) {
      sums(block.spline_columns[a], group) += sum[static_cast<Eigen::Index>(a)];
    }
  }
  Eigen::MatrixXd solved = sums;
  elimination.splines().solveInPlace(solved);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto col = static_cast<Eigen::Index>(g);
    groups[g].absorbed = sums.col(col).dot(solved.col(col));
  }
}

Eigen::MatrixXd totalInformation(const CalibrationProblem& problem, const Layout& layout) {
  Elimination elimination(problem, layout);
  elimination.eliminate();
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(layout.quantitySize(), layout.quantitySize());
  BlockJacobian block;
  for (const BlockInfo& info : problem.blocks()) {
    layout.evaluate(info, block);
    const Eigen::MatrixXd projected = elimination.project(block);
    total.noalias() += projected.transpose() * projected;
  }
  return total;
}

void addPixelErrors(const BlockInfo& info, const Eigen::MatrixXd& projected,
                    std::vector<Eigen::VectorXd>& effects) {
  Eigen::VectorXd change(info.circles->num_residuals());
  Eigen::Index row = 0;
  for (const CircleMeasurement& circle : info.circles->circles()) {
    change.segment<2>(row) = circle.whitening_px * circle.pixel_error_px;
    row += 2;
  }
  if (effects.size() <= info.sensor) effects.resize(info.sensor + 1, Eigen::VectorXd::Zero(projected.cols()));
  effects[info.sensor] += projected.transpose() * change;
}

// The splines of a problem, for a while elsewhere.
class SplineShift {
 public:
  explicit SplineShift(CalibrationProblem& problem) : problem_(problem) {
    for (double* block : problem.splineBlocks()) {
      blocks_.push_back(block);
      values_.insert(values_.end(), block, block + problem.problem().ParameterBlockSize(block));
    }
  }
  SplineShift(const SplineShift&) = delete;
  SplineShift& operator=(const SplineShift&) = delete;
  ~SplineShift() {
    const double* value = values_.data();
    for (double* block : blocks_) {
      std::copy_n(value, sizeOf(block), block);
      value += sizeOf(block);
    }
  }

  // From where they were, in tangent columns.
  void moveBy(const Eigen::VectorXd& shift) {
    const double *value = values_.data(), *step = shift.data();
    for (double* block : blocks_) {
      const ceres::Manifold* manifold = problem_.problem().GetManifold(block);
      if (manifold) {
        manifold->Plus(value, step, block);
      } else {
        std::transform(value, value + sizeOf(block), step, block, std::plus<>());
      }
      value += sizeOf(block);
      step += problem_.problem().ParameterBlockTangentSize(block);
    }
  }

 private:
  int sizeOf(const double* block) const { return problem_.problem().ParameterBlockSize(block); }

  CalibrationProblem& problem_;
  std::vector<double*> blocks_;
  std::vector<double> values_;
};

// Simulation and extrapolation (J. Cook, L. Stefanski, JASA 1994): errors once more of the size
// that the splines already have add once more what these have added. Either way, so that what
// is linear in them cancels.
Eigen::MatrixXd informationFromNoise(CalibrationProblem& problem, const Layout& layout,
                                     const BandCholesky& splines, const Eigen::MatrixXd& total) {
  constexpr std::uint64_t kSeed = 20260102;  // any
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd shift(layout.splineSize());
  for (double& each : shift) each = normal(random);
  splines.correlateInPlace(shift);
  SplineShift moved(problem);
  moved.moveBy(shift);
  const Eigen::MatrixXd ahead = totalInformation(problem, layout);
  moved.moveBy(-shift);
  return 0.5 * (ahead + totalInformation(problem, layout)) - total;
}

// Sums over stretches of time.
class Stretches {
 public:
  Stretches(Eigen::Index size, double length_s) : size_(size), length_s_(length_s) {}

  void add(double time_s, std::size_t group, const Eigen::VectorXd& score, const Eigen::MatrixXd& share) {
    Sums& sums = sums_[static_cast<std::int64_t>(std::floor(time_s / length_s_))];
    if (sums.information.size() == 0) sums.information = Eigen::MatrixXd::Zero(size_, size_);
    sums.information += share;
    if (sums.scores.size() <= group) sums.scores.resize(group + 1, Eigen::VectorXd::Zero(size_));
    sums.scores[group] += score;
  }

  void moveInto(ProjectedInformation& result) {
    if (sums_.empty()) return;
    const std::int64_t first = sums_.begin()->first, last = sums_.rbegin()->first;
    const auto count = static_cast<std::size_t>(last - first + 1);
    result.stretch_s = length_s_;
    result.first_stretch_s = static_cast<double>(first) * length_s_;
    result.scores.assign(count, Eigen::VectorXd::Zero(size_));
    result.information_by_stretch.assign(count, Eigen::MatrixXd::Zero(size_, size_));
    for (auto& [stretch, sums] : sums_) {
      const auto at = static_cast<std::size_t>(stretch - first);
      result.information_by_stretch[at] = std::move(sums.information);
      for (std::size_t g = 0; g < sums.scores.size(); ++g)
        result.scores[at] += std::sqrt(unabsorbed(result.groups[g])) * sums.scores[g];
    }
  }

 private:
  struct Sums {
    std::vector<Eigen::VectorXd> scores;  // by group
    Eigen::MatrixXd information;
  };

  // By how much squared residuals would be larger, had the unknowns not been fitted to them.
  static double unabsorbed(const MeasurementGroup& group) {
    return std::max(1.0, group.residuals / std::max(1.0, group.residuals - group.absorbed));
  }

  Eigen::Index size_;
  double length_s_;
  std::map<std::int64_t, Sums> sums_;
};

}  // namespace

double MeasurementGroup::variance() const {
  constexpr double kLeastFree =
      0.05;  // a group that the splines follow almost wholly tells nothing of its own noise
  const double free = residuals - absorbed;
  return kind != SensorKind::Prior && free > kLeastFree * residuals ? squared_residuals / free : 1.0;
}

ProjectedInformation projectInformation(CalibrationProblem& problem, double stretch_s,
                                        const RunContext& context) {
  const Layout layout(problem, context);
  Elimination elimination(problem, layout);
  elimination.eliminate();

  ProjectedInformation result;
  result.quantities = problem.quantities();
  result.first_column = layout.firstColumn();
  const Eigen::Index size = layout.quantitySize();
  result.total = Eigen::MatrixXd::Zero(size, size);
  result.gradient = Eigen::VectorXd::Zero(size);
  result.drift_by_quantities = elimination.driftByQuantities();
  result.drift_covariance = elimination.driftCovariance();

  Stretches stretches(size, stretch_s);
  BlockJacobian block;
  for (const BlockInfo& info : problem.blocks()) {
    layout.evaluate(info, block);
    const Eigen::MatrixXd projected = elimination.project(block);
    const std::size_t g = groupOf(result.groups, info, size);
    MeasurementGroup& group = result.groups[g];
    const Eigen::MatrixXd share = projected.transpose() * projected;
    group.information += share;
    group.squared_residuals += block.residuals.squaredNorm();
    group.residuals += static_cast<double>(block.residuals.size());
    const Eigen::VectorXd score = projected.transpose() * block.residuals;
    result.gradient += score;
    if (info.kind == SensorKind::Prior) continue;
    if (info.circles) addPixelErrors(info, projected, result.pixel_errors);
    stretches.add(info.time_s, g, score, share);
  }
  for (const MeasurementGroup& group : result.groups) result.total += group.information;
  countAbsorbed(problem, layout, elimination, result.groups);
  result.from_noise = informationFromNoise(problem, layout, elimination.splines(), result.total);

  stretches.moveInto(result);
  return result;
}

}  // namespace evical
