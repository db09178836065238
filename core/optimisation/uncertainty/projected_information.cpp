#include "core/optimisation/uncertainty/projected_information.h"

#include "core/base/in_parallel.h"
#include "core/numerics/band_cholesky.h"
#include "core/optimisation/block_jacobian.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/normal_equations.h"
#include "core/optimisation/unknown_columns.h"

#include <ceres/cost_function.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <tuple>
#include <utility>

namespace evical {
namespace {

using RowMajorMatrix = BandCholesky::RowMajorMatrix;

// Elimination of the splines, and of drifting biases' knots, from the batch's normal equations: the
// information on the quantities if all else is free to follow.
class SplineElimination {
 public:
  // `equations`: with the same columns.
  SplineElimination(const UnknownColumns& columns, NormalEquations equations);

  Eigen::Index quantities() const { return eliminated_.cols(); }
  // Derivatives of a control point, or a knot, by the quantities. P is J_q + J_x followers of x + J_k
  // followers of k.
  auto ofSpline(Eigen::Index column) const { return -eliminated_.row(column); }
  auto ofKnot(Eigen::Index column) const { return -drift_by_quantities_.row(column); }

  const BandCholesky& splines() const { return splines_; }  // factored
  // Negative derivatives of knots by quantities, and the knots' covariance if known.
  const Eigen::MatrixXd& driftByQuantities() const { return drift_by_quantities_; }
  const Eigen::MatrixXd& driftCovariance() const { return drift_covariance_; }

 private:
  void eliminateDrift(Eigen::Index quantities, const Eigen::MatrixXd& corner,
                      const RowMajorMatrix& knots_with_splines);

  BandCholesky splines_;
  RowMajorMatrix eliminated_;  // (J_x^T J_x)^-1 J_x^T J_q, with knots following
  Eigen::MatrixXd drift_by_quantities_, drift_covariance_;
};

SplineElimination::SplineElimination(const UnknownColumns& columns, NormalEquations equations)
    : splines_(std::move(equations.matrix.band())), eliminated_(std::move(equations.matrix.mixed())) {
  splines_.factorise();
  const RowMajorMatrix knots = eliminated_.rightCols(columns.driftSize());
  splines_.solveInPlace(eliminated_);
  if (columns.driftSize() > 0) eliminateDrift(columns.quantitySize(), equations.matrix.corner(), knots);
}

void SplineElimination::eliminateDrift(Eigen::Index quantities, const Eigen::MatrixXd& corner,
                                       const RowMajorMatrix& knots_with_splines) {
  const Eigen::Index knots = knots_with_splines.cols();
  Eigen::MatrixXd schur = corner.bottomRows(knots);
  schur.rightCols(knots).triangularView<Eigen::StrictlyUpper>() = schur.rightCols(knots).transpose();
  schur.noalias() -= knots_with_splines.transpose() * eliminated_;
  const Eigen::LDLT<Eigen::MatrixXd> solver(schur.rightCols(knots));
  drift_covariance_ = solver.solve(Eigen::MatrixXd::Identity(knots, knots));
  drift_by_quantities_ = solver.solve(schur.leftCols(quantities));
  RowMajorMatrix kept = eliminated_.leftCols(quantities);
  kept.noalias() -= eliminated_.rightCols(knots) * drift_by_quantities_;
  eliminated_ = std::move(kept);
}

// Kinds of measurements without their sums, and the kind of each residual block.
struct Groups {
  std::vector<MeasurementGroup> all;
  std::vector<std::size_t> of_block;
};
Groups groupsOf(const std::vector<BlockInfo>& blocks) {
  Groups groups;
  for (const BlockInfo& info : blocks) {
    const auto same = [&](const MeasurementGroup& g) {
      return g.kind == info.kind && g.sensor == info.sensor;
    };
    const auto found = std::find_if(groups.all.begin(), groups.all.end(), same);
    groups.of_block.push_back(static_cast<std::size_t>(found - groups.all.begin()));
    if (found != groups.all.end()) continue;
    MeasurementGroup& group = groups.all.emplace_back();
    group.kind = info.kind;
    group.sensor = info.sensor;
  }
  return groups;
}

// A fixed random sign for each residual of each block (the finaliser of splitmix64): the count is good to a
// fraction of a percent.
double signOf(std::size_t block, Eigen::Index residual) {
  std::uint64_t bits = (static_cast<std::uint64_t>(block) << 20U) + static_cast<std::uint64_t>(residual);
  bits = (bits + 0x9e3779b97f4a7c15U) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  return (bits >> 63U) != 0 ? 1.0 : -1.0;
}

// Circles whose errors may have a part in common: those of one point of the board, or of one place in the
// image.
struct ResidualCluster {
  enum class Kind { Point, Place } kind = Kind::Point;
  int index = 0;
  bool operator<(const ResidualCluster& other) const {
    return std::tie(kind, index) < std::tie(other.kind, other.index);
  }
};

// Sums over a stretch of time.
struct StretchSums {
  Eigen::MatrixXd information;
  std::vector<Eigen::VectorXd> scores;  // by group

  StretchSums(Eigen::Index quantities, std::size_t groups)
      : information(Eigen::MatrixXd::Zero(quantities, quantities)),
        scores(groups, Eigen::VectorXd::Zero(quantities)) {}
};

// Sums over the blocks of one part (UnknownColumns::Part), and over the parts.
struct Sums {
  std::vector<MeasurementGroup> groups;
  Eigen::VectorXd gradient;
  std::map<std::int64_t, StretchSums> stretches;
  std::vector<Eigen::VectorXd> pixel_errors;  // by camera index, up to the last camera with any
  std::map<std::pair<std::size_t, ResidualCluster>, Eigen::VectorXd> clusters;  // by group
  Eigen::Index first_row = 0;                                                   // of the band
  RowMajorMatrix signed_rows;  // J_x^T times random signs: rows of the band from there on, by group

  void add(Sums&& other);
};

void addTo(std::vector<Eigen::VectorXd>& sums, std::size_t index, const Eigen::VectorXd& change) {
  if (change.size() == 0) return;
  if (sums.size() <= index) sums.resize(index + 1, Eigen::VectorXd::Zero(change.size()));
  sums[index] += change;
}

void Sums::add(Sums&& other) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    groups[g].information += other.groups[g].information;
    groups[g].squared_residuals += other.groups[g].squared_residuals;
    groups[g].residuals += other.groups[g].residuals;
  }
  gradient += other.gradient;
  stretches.merge(other.stretches);
  for (const auto& [stretch, theirs] : other.stretches) {  // those that both have
    StretchSums& ours = stretches.at(stretch);
    ours.information += theirs.information;
    for (std::size_t g = 0; g < groups.size(); ++g) ours.scores[g] += theirs.scores[g];
  }
  clusters.merge(other.clusters);
  for (const auto& [cluster, theirs] : other.clusters)
    clusters.at(cluster) += theirs;  // clusters that both have
  for (std::size_t i = 0; i < other.pixel_errors.size(); ++i) addTo(pixel_errors, i, other.pixel_errors[i]);
  signed_rows.middleRows(other.first_row - first_row, other.signed_rows.rows()) += other.signed_rows;
}

// Information of the quantities at the current splines.
Eigen::MatrixXd informationHere(const UnknownColumns& columns, int threads, const RunContext& context,
                                NormalEquations& equations) {
  const Eigen::Index quantities = columns.quantitySize(), knots = columns.driftSize();
  assemble(columns, threads, context.stop, equations);
  const Eigen::MatrixXd left = equations.matrix.schurComplement();
  if (knots == 0) return left;
  const Eigen::LDLT<Eigen::MatrixXd> solver(left.bottomRightCorner(knots, knots));
  Eigen::MatrixXd of_quantities = left.topLeftCorner(quantities, quantities);
  of_quantities.triangularView<Eigen::Lower>() -=
      left.topRightCorner(quantities, knots) * solver.solve(left.bottomLeftCorner(knots, quantities));
  return of_quantities.selfadjointView<Eigen::Lower>();
}

// Contribution of the splines' own errors to the information of the quantities: the mean, by simulation and
// extrapolation (J. Cook, L. Stefanski, JASA 1994). Further errors of the size that the splines already have
// add the same contribution again. `splines`: their factored information; `total`: that of the quantities at
// the solution's splines. Both signs, so that linear terms cancel.
Eigen::MatrixXd informationFromNoise(const UnknownColumns& columns, const BandCholesky& splines,
                                     const Eigen::MatrixXd& total, int threads, const RunContext& context) {
  constexpr std::uint64_t kSeed = 20260102;  // arbitrary
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd of_splines(columns.splineSize());
  for (double& each : of_splines) each = normal(random);
  splines.correlateInPlace(of_splines);
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(columns.size());
  shift.head(of_splines.size()) = of_splines;
  const UnknownNumbers numbers(columns);
  const Eigen::VectorXd solution = numbers.read();
  NormalEquations equations(columns);
  numbers.writeMoved(solution, shift);
  const Eigen::MatrixXd ahead = informationHere(columns, threads, context, equations);
  numbers.writeMoved(solution, -shift);
  const Eigen::MatrixXd behind = informationHere(columns, threads, context, equations);
  numbers.write(solution);
  return 0.5 * (ahead + behind) - total;
}

class Projection {
 public:
  Projection(CalibrationProblem& problem, double stretch_s, int threads, const RunContext& context)
      : problem_(problem),
        stretch_s_(stretch_s),
        threads_(threads),
        context_(context),
        columns_(problem),
        groups_(groupsOf(problem.blocks())),
        elimination_(columns_, equations()) {}

  ProjectedInformation run();

 private:
  NormalEquations equations() const {
    NormalEquations equations(columns_);
    assemble(columns_, threads_, context_.stop, equations);
    return equations;
  }
  Sums noSums(Eigen::Index first_row, Eigen::Index end_row) const;
  Sums sumOf(const UnknownColumns::Part& part, const ManifoldDerivatives& manifolds) const;
  Sums sumOfAll() const;
  void addSigns(std::size_t index, const BlockJacobian& block, Sums& sums) const;
  Eigen::MatrixXd byQuantities(const BlockJacobian& block) const;
  void add(std::size_t index, const BlockJacobian& block, Sums& sums) const;
  void addClusters(std::size_t group, const ViewCost& view, const Eigen::MatrixXd& scores, Sums& sums) const;
  void countAbsorbed(Sums& sums) const;
  void reportStretches(Sums& sums, ProjectedInformation& result) const;
  void reportClusters(const Sums& sums, ProjectedInformation& result) const;

  CalibrationProblem& problem_;
  double stretch_s_;
  int threads_;
  const RunContext& context_;
  UnknownColumns columns_;
  Groups groups_;
  SplineElimination elimination_;
};

Sums Projection::noSums(Eigen::Index first_row, Eigen::Index end_row) const {
  const Eigen::Index quantities = columns_.quantitySize();
  Sums sums;
  sums.groups = groups_.all;
  for (MeasurementGroup& group : sums.groups)
    group.information = Eigen::MatrixXd::Zero(quantities, quantities);
  sums.gradient = Eigen::VectorXd::Zero(quantities);
  sums.first_row = first_row;
  sums.signed_rows = RowMajorMatrix::Zero(end_row - first_row, static_cast<Eigen::Index>(groups_.all.size()));
  return sums;
}

void Projection::addSigns(std::size_t index, const BlockJacobian& block, Sums& sums) const {
  const auto group = static_cast<Eigen::Index>(groups_.of_block[index]);
  Eigen::VectorXd signs(block.rows());
  for (Eigen::Index row = 0; row < block.rows(); ++row) signs[row] = signOf(index, row);
  const Eigen::VectorXd sum = block.weightedSum(signs);
  for (std::size_t k = 0; k < block.splineColumns().size(); ++k)
    sums.signed_rows(block.splineColumns()[k] - sums.first_row, group) += sum[static_cast<Eigen::Index>(k)];
}

// Change of a view's residuals by one sigma of the pixels' repeated errors.
Eigen::VectorXd pixelErrorsOf(const ViewCost& view) {
  Eigen::VectorXd change(view.num_residuals());
  Eigen::Index row = 0;
  for (const CircleMeasurement& circle : view.circles()) {
    change.segment<2>(row) = circle.whitening_px * circle.pixel_error_px;
    row += 2;
  }
  view.whiten(change.data());
  return change;
}

// Derivatives of the block's own columns by the quantities, with all else following.
Eigen::MatrixXd Projection::byQuantities(const BlockJacobian& block) const {
  Eigen::MatrixXd by(static_cast<Eigen::Index>(block.columnCount()), elimination_.quantities());
  Eigen::Index at = 0;
  for (const Eigen::Index column : block.splineColumns()) by.row(at++) = elimination_.ofSpline(column);
  for (const Eigen::Index column : block.borderColumns()) {
    if (column < columns_.quantitySize())
      by.row(at++) = Eigen::RowVectorXd::Unit(by.cols(), column);
    else
      by.row(at++) = elimination_.ofKnot(column - columns_.quantitySize());
  }
  return block.ofOwnColumns(by);
}

// Scores of circles: summed by point and by place.
void Projection::addClusters(std::size_t group, const ViewCost& view, const Eigen::MatrixXd& scores,
                             Sums& sums) const {
  for (std::size_t i = 0; i < view.circles().size(); ++i) {
    const CircleMeasurement& circle = view.circles()[i];
    for (const ResidualCluster cluster : {ResidualCluster{ResidualCluster::Kind::Point, circle.point},
                                          ResidualCluster{ResidualCluster::Kind::Place, circle.place}}) {
      const auto score = scores.row(static_cast<Eigen::Index>(i)).transpose();
      const auto [at, is_new] = sums.clusters.try_emplace({group, cluster}, score);
      if (!is_new) at->second += score;
    }
  }
}

// Products are projected if there are more rows than columns, otherwise the rows.
void Projection::add(std::size_t index, const BlockJacobian& block, Sums& sums) const {
  const std::size_t group = groups_.of_block[index];
  const BlockInfo& info = problem_.blocks()[index];
  const auto rows = block.ownRows();
  const Eigen::MatrixXd by_quantities = byQuantities(block);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(by_quantities.cols(), by_quantities.cols());
  if (rows.rows() > rows.cols())
    information = by_quantities.transpose() * (rows.transpose() * rows) * by_quantities;
  else
    information.selfadjointView<Eigen::Lower>().rankUpdate((rows * by_quantities).transpose());
  information.triangularView<Eigen::StrictlyUpper>() = information.transpose();
  const Eigen::VectorXd score = by_quantities.transpose() * (rows.transpose() * block.residuals());
  MeasurementGroup& of_group = sums.groups[group];
  of_group.information += information;
  of_group.squared_residuals += block.residuals().squaredNorm();
  of_group.residuals += static_cast<double>(block.rows());
  sums.gradient += score;
  addSigns(index, block, sums);
  if (of_group.kind == SensorKind::Prior) return;
  const auto stretch = static_cast<std::int64_t>(std::floor(info.time_s / stretch_s_));
  StretchSums& at =
      sums.stretches.try_emplace(stretch, sums.gradient.size(), sums.groups.size()).first->second;
  at.information += information;
  at.scores[group] += score;
  if (info.view == nullptr) return;
  addTo(sums.pixel_errors, of_group.sensor,
        by_quantities.transpose() * (rows.transpose() * pixelErrorsOf(*info.view)));
  addClusters(group, *info.view, block.pairScores() * by_quantities, sums);
}

Sums Projection::sumOf(const UnknownColumns::Part& part, const ManifoldDerivatives& manifolds) const {
  const Eigen::Index rows = columns_.splineSize();
  const Eigen::Index end_row = std::min(rows, part.end_row + columns_.halfBandwidth() + 1);
  Sums sums = noSums(std::min(part.first_row, end_row), end_row);
  BlockJacobian block(columns_);
  for (std::size_t i = part.begin; i < part.end; ++i) {
    context_.throwIfStopped();
    const std::size_t index = columns_.order()[i];
    block.evaluate(index, manifolds);
    add(index, block, sums);
  }
  return sums;
}

Sums Projection::sumOfAll() const {
  const ManifoldDerivatives manifolds(columns_);
  std::vector<Sums> parts(columns_.parts().size());
  inParallel(threads_, parts.size(),
             [&](std::size_t p) { parts[p] = sumOf(columns_.parts()[p], manifolds); });
  Sums all = noSums(0, columns_.splineSize());
  for (Sums& part : parts) all.add(std::exchange(part, {}));
  return all;
}

// Number of residuals of each group that the splines absorb: trace of J_x (J_x^T J_x)^-1 J_x^T over the
// group's rows, by random signs (Hutchinson 1990). The few quantities themselves don't matter.
void Projection::countAbsorbed(Sums& sums) const {
  RowMajorMatrix solved = sums.signed_rows;
  elimination_.splines().solveInPlace(solved);
  for (std::size_t g = 0; g < sums.groups.size(); ++g) {
    const auto col = static_cast<Eigen::Index>(g);
    sums.groups[g].absorbed = sums.signed_rows.col(col).dot(solved.col(col));
  }
}

// Factor by which squared residuals would be larger if the unknowns were not fitted to them.
double unabsorbed(const MeasurementGroup& group) {
  return std::max(1.0, group.residuals / std::max(1.0, group.residuals - group.absorbed));
}

void Projection::reportStretches(Sums& sums, ProjectedInformation& result) const {
  if (sums.stretches.empty()) return;
  const Eigen::Index size = columns_.quantitySize();
  const std::int64_t first = sums.stretches.begin()->first, last = sums.stretches.rbegin()->first;
  const auto count = static_cast<std::size_t>(last - first + 1);
  result.stretch_s = stretch_s_;
  result.first_stretch_s = static_cast<double>(first) * stretch_s_;
  result.scores.assign(count, Eigen::VectorXd::Zero(size));
  result.information_by_stretch.resize(count);  // those of the sums, moved
  for (auto& [stretch, of_stretch] : sums.stretches) {
    const auto at = static_cast<std::size_t>(stretch - first);
    result.information_by_stretch[at] = std::move(of_stretch.information);
    for (std::size_t g = 0; g < of_stretch.scores.size(); ++g)
      result.scores[at] += std::sqrt(unabsorbed(result.groups[g])) * of_stretch.scores[g];
  }
  for (Eigen::MatrixXd& information : result.information_by_stretch)
    if (information.size() == 0) information = Eigen::MatrixXd::Zero(size, size);
}

void Projection::reportClusters(const Sums& sums, ProjectedInformation& result) const {
  for (const auto& [cluster, score] : sums.clusters) {
    const MeasurementGroup& group = result.groups[cluster.first];
    const bool by_place = cluster.second.kind == ResidualCluster::Kind::Place;
    const auto same = [&](const ClusterScatter& each) {
      return each.camera == group.sensor && each.by_place == by_place;
    };
    auto found = std::ranges::find_if(result.clusters, same);
    if (found == result.clusters.end())
      found = result.clusters.insert(
          found, {group.sensor, by_place, 0, Eigen::MatrixXd::Zero(score.size(), score.size())});
    ++found->clusters;
    found->scatter.noalias() += unabsorbed(group) * score * score.transpose();
  }
}

ProjectedInformation Projection::run() {
  const Eigen::Index size = columns_.quantitySize();
  ProjectedInformation result;
  result.quantities = problem_.quantities();
  result.first_column = columns_.firstColumn();
  result.total = Eigen::MatrixXd::Zero(size, size);
  result.drift_by_quantities = elimination_.driftByQuantities();
  result.drift_covariance = elimination_.driftCovariance();
  {
    Sums sums = sumOfAll();
    countAbsorbed(sums);
    result.groups = std::move(sums.groups);
    for (const MeasurementGroup& group : result.groups) result.total += group.information;
    result.gradient = std::move(sums.gradient);
    result.pixel_errors = std::move(sums.pixel_errors);
    reportStretches(sums, result);
    reportClusters(sums, result);
  }
  result.from_noise =
      informationFromNoise(columns_, elimination_.splines(), result.total, threads_, context_);
  return result;
}

}  // namespace

double MeasurementGroup::variance() const {
  constexpr double kMinFree =
      0.05;  // below, splines follow the group almost completely, and its noise is not observable
  const double free = residuals - absorbed;
  return kind != SensorKind::Prior && free > kMinFree * residuals ? squared_residuals / free : 1.0;
}

ProjectedInformation projectInformation(CalibrationProblem& problem, double stretch_s, int threads,
                                        const RunContext& context) {
  return Projection(problem, stretch_s, threads, context).run();
}

}  // namespace evical
