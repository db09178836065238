#include "core/optimisation/uncertainty/schur_columns.h"

#include "core/data/quantity.h"
#include "core/numerics/dense.h"

#include <cassert>
#include <cmath>
#include <utility>

namespace evical {

void KeptColumns::keep(std::size_t quantity) {
  quantities_.push_back(quantity);
  ties_.push_back({quantity, quantity});
}

void KeptColumns::tie(std::size_t quantity, std::size_t to_kept) {
  assert(sizeOf(quantity) == sizeOf(to_kept));
  ties_.push_back({quantity, to_kept});
}

Eigen::MatrixXd KeptColumns::allFromKept() const {
  std::vector<Eigen::Index> first(first_column_.size(), -1);
  Eigen::Index columns = 0;
  for (const std::size_t quantity : quantities_) {
    first[quantity] = columns;
    columns += sizeOf(quantity);
  }
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(first_column_.back(), columns);
  for (const Tie& tie : ties_) {
    const Eigen::Index size = sizeOf(tie.quantity);
    matrix.block(first_column_[tie.quantity], first[tie.to], size, size).setIdentity();
  }
  return matrix;
}

ProjectedInformation withColumns(const KeptColumns& kept, ProjectedInformation information) {
  const Eigen::MatrixXd all_from_kept = kept.allFromKept();
  std::vector<Quantity> quantities;
  std::vector<Eigen::Index> first_column = {0};
  for (const std::size_t quantity : kept.quantities()) {
    quantities.push_back(information.quantities[quantity]);
    first_column.push_back(first_column.back() + information.first_column[quantity + 1] -
                           information.first_column[quantity]);
  }
  information.quantities = std::move(quantities);
  information.first_column = std::move(first_column);
  const auto reduceMatrix = [&](Eigen::MatrixXd& matrix) {
    matrix = (all_from_kept.transpose() * matrix * all_from_kept).eval();
  };
  const auto reduceVector = [&](Eigen::VectorXd& vector) {
    vector = (all_from_kept.transpose() * vector).eval();
  };
  reduceMatrix(information.total);
  reduceMatrix(information.from_noise);
  reduceVector(information.gradient);
  for (MeasurementGroup& group : information.groups) reduceMatrix(group.information);
  for (Eigen::VectorXd& score : information.scores) reduceVector(score);
  for (Eigen::MatrixXd& share : information.information_by_stretch) reduceMatrix(share);
  for (Eigen::VectorXd& effect : information.pixel_errors) reduceVector(effect);
  for (ClusterScatter& each : information.clusters) reduceMatrix(each.scatter);
  if (information.drift_by_quantities.size() > 0)
    information.drift_by_quantities = (information.drift_by_quantities * all_from_kept).eval();
  return information;
}

namespace {

// Errors of a window's circles have common parts, so that the splines have larger errors than their
// information indicates: by a factor of three in simulated recordings.
constexpr double kNoiseFactor = 10.0;
// Delays are determined from the trajectory's jerk, whose errors come from the accelerometer: white, so that
// their factor is near 1.
constexpr double kDelayNoiseFactor = 3.0;
constexpr double kMinShare = 1e-12;  // of the strongest direction, for the decomposition only

// Information added by noise, times its factor.
Eigen::MatrixXd feigned(const ProjectedInformation& information) {
  Eigen::VectorXd root = Eigen::VectorXd::Constant(information.total.rows(), std::sqrt(kNoiseFactor));
  for (std::size_t i = 0; i < information.quantities.size(); ++i)
    if (information.quantities[i].info->id == QuantityId::AccelerometerDelay)
      root[information.first_column[i]] = std::sqrt(kDelayNoiseFactor);
  return root.asDiagonal() * information.from_noise * root.asDiagonal();
}

}  // namespace

ProjectedInformation withoutNoise(ProjectedInformation information) {
  const Eigen::Index size = information.total.rows();
  Eigen::MatrixXd measured = Eigen::MatrixXd::Zero(size, size);
  for (const MeasurementGroup& group : information.groups) {
    if (group.kind != SensorKind::Prior) measured += group.information;
  }
  // Diagonal 1, then the square root: directions in which one unit is one sigma.
  const Eigen::VectorXd scale = measured.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::VectorXd inverse_scale = scale.cwiseInverse();
  const SymmetricEigen whole =
      symmetricEigen(inverse_scale.asDiagonal() * measured * inverse_scale.asDiagonal());
  const Eigen::VectorXd root = whole.values.cwiseMax(kMinShare * whole.values.maxCoeff()).cwiseSqrt();
  const Eigen::MatrixXd from_sigmas = scale.asDiagonal() * whole.vectors * root.asDiagonal();
  const Eigen::MatrixXd to_sigmas =
      root.cwiseInverse().asDiagonal() * whole.vectors.transpose() * inverse_scale.asDiagonal();
  const SymmetricEigen noise = symmetricEigen(congruence(to_sigmas, feigned(information)));
  const Eigen::VectorXd kept = (1.0 - noise.values.array()).cwiseMax(0.0).cwiseMin(1.0).sqrt().matrix();
  const Eigen::MatrixXd keep_in_sigmas =
      productTransposed(product(from_sigmas, noise.vectors) * kept.asDiagonal(), noise.vectors);
  const Eigen::MatrixXd keep = product(keep_in_sigmas, to_sigmas);
  information.total.setZero();
  for (MeasurementGroup& group : information.groups) {
    if (group.kind != SensorKind::Prior) group.information = congruence(keep, group.information);
    information.total += group.information;
  }
  for (Eigen::VectorXd& score : information.scores) score = (keep * score).eval();
  for (Eigen::MatrixXd& share : information.information_by_stretch) share = congruence(keep, share);
  for (Eigen::VectorXd& effect : information.pixel_errors) effect = (keep * effect).eval();
  for (ClusterScatter& each : information.clusters) each.scatter = congruence(keep, each.scatter);
  return information;
}

}  // namespace evical
