#include "core/optimisation/uncertainty/quantity_covariance.h"

#include "core/data/pixel_delay.h"
#include "core/numerics/dense.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/optimisation/uncertainty/score_test.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace evical {
namespace {

// A comparable size of focal lengths and principal point, the first four intrinsics.
constexpr double kPixelUnit = 0.1;

constexpr double kMinVariance = 1e-300;

// Below this information in the units above a direction counts as open, and its sigma is 1e4 units.
constexpr double kMinInformation = 1e-8;

// Inverse of the information, also if it is singular: directions without information get the least that is
// allowed. `open` is this addition.
struct SafeInverse {
  Eigen::MatrixXd inverse, open;
};
SafeInverse safeInverse(const Eigen::MatrixXd& information, const Eigen::VectorXd& units) {
  const SymmetricEigen eigen = symmetricEigen(units.asDiagonal() * information * units.asDiagonal());
  const Eigen::MatrixXd& v = eigen.vectors;
  const Eigen::VectorXd known = eigen.values.cwiseMax(kMinInformation);
  const Eigen::VectorXd missing = known - eigen.values;
  const Eigen::VectorXd per_unit = units.cwiseInverse();
  return {
      units.asDiagonal() * productTransposed(v * known.cwiseInverse().asDiagonal(), v) * units.asDiagonal(),
      per_unit.asDiagonal() * productTransposed(v * missing.asDiagonal(), v) * per_unit.asDiagonal()};
}

Eigen::MatrixXd reportFromTangent(const Quantity& quantity, Eigen::Index size, const CalibrationState& state,
                                  ceres::Problem& problem) {
  if (quantity.info->shape == QuantityShape::Rotation)
    return Eigen::Map<const Eigen::Quaterniond>(quantity.block).toRotationMatrix();
  if (quantity.info->shape == QuantityShape::Gravity) {
    const Eigen::Vector3d& gravity = state.gravity_in_world_m_s2;
    const Eigen::Matrix<double, 2, 3> tilts = gravityTilts(gravity).transpose() / gravity.norm();
    if (size == 3) return (Eigen::Matrix3d() << tilts, gravity.normalized().transpose()).finished();
    Eigen::Matrix<double, 3, 2, Eigen::RowMajor> plus;
    problem.GetManifold(quantity.block)->PlusJacobian(quantity.block, plus.data());
    return tilts * plus;
  }
  return Eigen::MatrixXd::Identity(size, size);
}

constexpr auto kBlock = static_cast<std::ptrdiff_t>(kScoreLags) + 1;  // stretches

// By blocks of a few stretches of time, at every stretch: within a block errors may be correlated.
struct BlockErrors {
  Eigen::MatrixXd information;
  Eigen::MatrixXd white_left;  // what scoreScatter would be of errors that are white
  // Covariance of the estimate from its changes if one block is omitted (jackknife). Residuals of a block
  // that was used show only a part of its errors, because the estimate has followed it: the larger its
  // weight, the smaller this part.
  Eigen::MatrixXd whole;
};

BlockErrors blockErrors(const ProjectedInformation& information, const Eigen::MatrixXd& total,
                        const Eigen::MatrixXd& inverse) {
  constexpr double kWeight = 1.0 / static_cast<double>(kBlock);  // of each, since they overlap
  constexpr double kLargestShare = 0.98;  // of a block that holds all that is known of something
  const auto count = static_cast<std::ptrdiff_t>(information.scores.size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(total.rows(), total.cols());
  BlockErrors errors{zero, zero, zero};
  for (std::ptrdiff_t first = 1 - kBlock; first < count; ++first) {
    Eigen::VectorXd score = Eigen::VectorXd::Zero(total.rows());
    Eigen::MatrixXd share = zero;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(first, 0); k < std::min(first + kBlock, count); ++k) {
      score += information.scores[static_cast<std::size_t>(k)];
      share += information.information_by_stretch[static_cast<std::size_t>(k)];
    }
    const Eigen::VectorXd step = ScaledInverse(total - kLargestShare * share).times(score);
    errors.information += kWeight * share;
    errors.white_left += kWeight * (share - congruence(share, inverse));
    errors.whole.noalias() += kWeight * step * step.transpose();
  }
  return errors;
}

// Ratio, for each number, of the sigma with correlated errors to the sigma with white errors.
Eigen::VectorXd growthOf(const ProjectedInformation& information, const Eigen::MatrixXd& white,
                         const SafeInverse& safe, const Eigen::MatrixXd& given,
                         const Eigen::MatrixXd& report_from_tangent) {
  const Eigen::MatrixXd inverse = product(report_from_tangent, safe.inverse);
  const BlockErrors errors = blockErrors(information, information.total + safe.open, safe.inverse);
  const Eigen::VectorXd known = congruence(inverse, given).diagonal();
  const Eigen::VectorXd left = congruence(inverse, scoreScatter(information.scores, white.rows())).diagonal();
  const Eigen::VectorXd white_left = congruence(inverse, errors.white_left).diagonal();
  const Eigen::VectorXd stated = congruence(inverse, errors.information).diagonal();
  const Eigen::VectorXd whole = congruence(report_from_tangent, errors.whole).diagonal() + known;
  // Scatter of the estimated variance if errors are white: it is a mean of squares over overlapping blocks.
  constexpr double kCertain_sigmas = 3.0;
  const double doubtless =
      kCertain_sigmas * std::sqrt(4.0 / 3.0 * static_cast<double>(kBlock) /
                                  std::max(1.0, static_cast<double>(information.scores.size())));
  Eigen::VectorXd growth(white.rows());
  for (Eigen::Index i = 0; i < growth.size(); ++i) {
    const double variance = std::max(white(i, i), kMinVariance);
    const double scale = (variance - known[i]) / std::max(stated[i], kMinVariance);  // of residuals, squared
    const double ratio = left[i] / std::max(scale * white_left[i], kMinVariance);
    const double certain = std::clamp((ratio - 1.0) / doubtless, 0.0, 1.0);
    growth[i] = std::sqrt(1.0 + certain * std::max(0.0, whole[i] / variance - 1.0));
  }
  return growth;
}

// Variance of each number that errors add which circles of one point of the board, or of one place in the
// image, have in common: the larger of both for each camera. `inverse`: report from scores.
Eigen::VectorXd varianceOfClusters(const ProjectedInformation& information, const Eigen::MatrixXd& inverse) {
  constexpr double kCertain_sigmas = 3.0;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(inverse.rows());
  for (const MeasurementGroup& group : information.groups) {
    if (group.kind != SensorKind::Circles) continue;
    const Eigen::VectorXd white = group.variance() * congruence(inverse, group.information).diagonal();
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(sum.size());
    for (const ClusterScatter& each : information.clusters) {
      if (each.camera != group.sensor || each.clusters < 2) continue;
      const Eigen::VectorXd seen = congruence(inverse, each.scatter).diagonal();
      const double doubtless = kCertain_sigmas * std::sqrt(2.0 / each.clusters);
      for (Eigen::Index i = 0; i < sum.size(); ++i) {
        const double ratio = seen[i] / std::max(white[i], kMinVariance);
        const double certain = std::clamp((ratio - 1.0) / doubtless, 0.0, 1.0);
        largest[i] = std::max(largest[i], certain * (seen[i] - white[i]));
      }
    }
    sum += largest;
  }
  return sum;
}

// The lag of centres is a mean of the lags of brightening and darkening edges, with weights known to a
// quarter.
double delayVariance_s2(const BoardObservations& seen, const OptimisationOptions& options) {
  constexpr double kShare = 0.25;
  // Rounded stamps are late or early by up to a step, all of them alike.
  const double delay_s = std::hypot(1e-3 * options.pixel_delay_ms, 0.5 * seen.stamp_step_s);
  if (!seen.polarity_delay) return delay_s * delay_s;
  const double more_s = std::max(0.0, std::abs(seen.polarity_delay->later_s) - 1e-3 * options.slow_pixels_ms);
  return delay_s * delay_s + kShare * kShare * more_s * more_s;
}

}  // namespace

Eigen::MatrixXd reportFromTangent(const ProjectedInformation& information, const CalibrationState& state,
                                  ceres::Problem& problem) {
  const Eigen::Index size = information.total.rows();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < information.quantities.size(); ++i) {
    const Eigen::Index first = information.first_column[i], count = information.first_column[i + 1] - first;
    matrix.block(first, first, count, count) =
        reportFromTangent(information.quantities[i], count, state, problem);
  }
  return matrix;
}

QuantityCovariance quantityCovariance(const ProjectedInformation& information,
                                      const Eigen::MatrixXd& report_from_tangent) {
  const Eigen::Index size = information.total.rows();
  Eigen::VectorXd units(size);
  for (std::size_t i = 0; i < information.quantities.size(); ++i) {
    const Eigen::Index first = information.first_column[i], count = information.first_column[i + 1] - first;
    units.segment(first, count).setConstant(information.quantities[i].info->comparable_unit);
    if (information.quantities[i].info->shape == QuantityShape::Intrinsics)
      units.segment<4>(first).setConstant(kPixelUnit);
  }
  const SafeInverse safe = safeInverse(information.total, units);
  // Information and errors beyond the data: priors, the floor under open directions, errors that repeat.
  Eigen::MatrixXd given = safe.open, measured = Eigen::MatrixXd::Zero(size, size);
  for (const MeasurementGroup& group : information.groups) {
    (group.kind == SensorKind::Prior ? given : measured) += group.variance() * group.information;
  }
  for (const Eigen::VectorXd& effect : information.pixel_errors) given += effect * effect.transpose();
  const Eigen::MatrixXd inverse = product(report_from_tangent, safe.inverse);
  Eigen::MatrixXd covariance = congruence(inverse, measured + given);
  Eigen::VectorXd growth = growthOf(information, covariance, safe, given, report_from_tangent);
  const Eigen::VectorXd clusters = varianceOfClusters(information, inverse);
  for (Eigen::Index i = 0; i < size; ++i)
    growth[i] = std::max(growth[i], std::sqrt(1.0 + clusters[i] / std::max(covariance(i, i), kMinVariance)));
  covariance = (growth.asDiagonal() * covariance * growth.asDiagonal()).eval();
  return {information.quantities, information.first_column, covariance,
          congruence(report_from_tangent, safe.inverse)};
}

QuantityCovariance withPixelDelay(const CalibrationInput& input, const OptimisationOptions& options,
                                  QuantityCovariance covariance) {
  std::vector<CameraKind> kinds;
  for (const CameraData& camera : input.cameras) kinds.push_back(camera.observations.kind);
  const double missed_motion_s = 1e-6 * options.missed_motion_us;
  for (std::size_t i = 0; i < covariance.quantities.size(); ++i) {
    const Quantity& quantity = covariance.quantities[i];
    const Eigen::Index column = covariance.first_column[i];
    if (quantity.info->id == QuantityId::AccelerometerDelay)
      covariance.covariance(column, column) += missed_motion_s * missed_motion_s;
    if (!quantity.info->is(QuantityOwner::Camera, QuantityId::TimeOffset) ||
        !holdsPixelDelay(kinds, quantity.sensor, !input.imus.empty()))
      continue;
    covariance.covariance(column, column) +=
        delayVariance_s2(input.cameras[quantity.sensor].observations, options);
  }
  return covariance;
}

}  // namespace evical
