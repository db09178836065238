#include "core/optimisation/uncertainty/quantity_covariance.h"

#include "core/numerics/dense.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/optimisation/uncertainty/score_scatter.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// A comparable size of focal lengths and principal point, the first four intrinsics.
constexpr double kPixelUnit = 0.1;

// Below this information in the units above a direction counts as open, and its sigma is 1e4 units.
constexpr double kLeastInformation = 1e-8;

// Inverse of the information, safe against directions without any: they count as having
// the least, which `open` holds.
struct SafeInverse {
  Eigen::MatrixXd inverse, open;
};
SafeInverse safeInverse(const Eigen::MatrixXd& information, const Eigen::VectorXd& units) {
  const SymmetricEigen eigen = symmetricEigen(units.asDiagonal() * information * units.asDiagonal());
  const Eigen::MatrixXd& v = eigen.vectors;
  const Eigen::VectorXd known = eigen.values.cwiseMax(kLeastInformation);
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

}  // namespace

Eigen::Matrix<double, 3, 2> gravityTilts(const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d down = gravity.normalized();
  const Eigen::Vector3d seed = std::abs(down.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix<double, 3, 2> tilts;
  tilts.col(0) = (seed - seed.dot(down) * down).normalized();
  tilts.col(1) = down.cross(tilts.col(0));
  return tilts;
}

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
  // What the data doesn't say of its own: priors, the floor under open directions, errors that repeat.
  Eigen::MatrixXd given = safe.open, measured = Eigen::MatrixXd::Zero(size, size);
  for (const MeasurementGroup& group : information.groups) {
    (group.kind == SensorKind::Prior ? given : measured) += group.variance() * group.information;
  }
  for (const Eigen::VectorXd& effect : information.pixel_errors) given += effect * effect.transpose();
  const Eigen::MatrixXd inverse = product(report_from_tangent, safe.inverse);
  Eigen::MatrixXd covariance = congruence(inverse, measured + given);
  const Eigen::MatrixXd correlated = congruence(inverse, scoreScatter(information.scores, size) + given);
  Eigen::VectorXd growth(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double asked = std::max(covariance(i, i), correlated(i, i));
    growth[i] = std::sqrt(std::max(1.0, asked / std::max(covariance(i, i), 1e-300)));
  }
  covariance = (growth.asDiagonal() * covariance * growth.asDiagonal()).eval();
  return {information.quantities, information.first_column, covariance};
}

}  // namespace evical
