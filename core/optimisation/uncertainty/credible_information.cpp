#include "core/optimisation/uncertainty/credible_information.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <utility>

namespace evical {
namespace {

// Errors of a window's circles have parts in common, and the splines therefore larger errors than their
// information says: three times, in simulated recordings.
constexpr double kNoiseFactor = 10.0;
constexpr double kLeastShare = 1e-12;  // of the strongest direction, for the decomposition only

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
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> whole(inverse_scale.asDiagonal() * measured *
                                                             inverse_scale.asDiagonal());
  const Eigen::VectorXd root =
      whole.eigenvalues().cwiseMax(kLeastShare * whole.eigenvalues().maxCoeff()).cwiseSqrt();
  const Eigen::MatrixXd from_sigmas = scale.asDiagonal() * whole.eigenvectors() * root.asDiagonal();
  const Eigen::MatrixXd to_sigmas =
      root.cwiseInverse().asDiagonal() * whole.eigenvectors().transpose() * inverse_scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> noise(to_sigmas * information.from_noise *
                                                             to_sigmas.transpose());
  const Eigen::VectorXd kept =
      (1.0 - kNoiseFactor * noise.eigenvalues().array()).cwiseMax(0.0).cwiseMin(1.0).sqrt().matrix();
  const Eigen::MatrixXd keep =
      from_sigmas * noise.eigenvectors() * kept.asDiagonal() * noise.eigenvectors().transpose() * to_sigmas;
  information.total.setZero();
  for (MeasurementGroup& group : information.groups) {
    if (group.kind != SensorKind::Prior)
      group.information = (keep * group.information * keep.transpose()).eval();
    information.total += group.information;
  }
  for (Eigen::VectorXd& score : information.scores) score = (keep * score).eval();
  for (Eigen::VectorXd& effect : information.pixel_errors) effect = (keep * effect).eval();
  return information;
}

}  // namespace evical
