#include "core/optimisation/uncertainty/noise_corrected_information.h"

#include "core/data/quantity.h"
#include "core/numerics/dense.h"

#include <cmath>
#include <utility>

namespace evical {
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
