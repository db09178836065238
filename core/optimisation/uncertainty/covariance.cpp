#include "core/optimisation/uncertainty/covariance.h"

#include "core/data/doubt.h"
#include "core/geometry/intrinsics_numbers.h"
#include "core/numerics/newey_west.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/known_values.h"
#include "core/optimisation/uncertainty/credible_information.h"
#include "core/optimisation/uncertainty/drift_uncertainty.h"
#include "core/optimisation/uncertainty/observability.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/optimisation/uncertainty/turned_gyroscope.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

// Sizes that make all quantities comparable, so that "no information" means the same for each.
double unitOf(QuantityKind kind) {
  switch (kind) {
    case QuantityKind::CameraTranslation:
    case QuantityKind::ImuTranslation:
      return 1e-3;
    case QuantityKind::CameraTimeOffset:
    case QuantityKind::ImuTimeOffset:
      return 1e-4;
    case QuantityKind::EdgeLead:
      return 0.1;
    case QuantityKind::EdgeLeadGrowth:
      return 1e-2;
    case QuantityKind::AccelerometerBias:
      return 1e-2;
    default:
      return 1e-3;
  }
}

// Scores come in stretches of the correlation time: weights that fall to zero over the next three see
// correlation over up to about that time in full.
constexpr std::size_t kLags = 3;

constexpr double kPixelUnit = 0.1;  // of focal lengths and principal point, the first four intrinsics

// Below this information in the units above a direction counts as open, and its sigma is 1e4 units.
constexpr double kLeastInformation = 1e-8;

// Inverse of the information, safe against directions without any: they count as having the least, which
// `open` holds.
struct SafeInverse {
  Eigen::MatrixXd inverse, open;
};
SafeInverse safeInverse(const Eigen::MatrixXd& information, const Eigen::VectorXd& units) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(units.asDiagonal() * information *
                                                              units.asDiagonal());
  const Eigen::MatrixXd& v = solver.eigenvectors();
  const Eigen::VectorXd known = solver.eigenvalues().cwiseMax(kLeastInformation);
  const Eigen::VectorXd missing = known - solver.eigenvalues();
  const Eigen::VectorXd per_unit = units.cwiseInverse();
  return {units.asDiagonal() * (v * known.cwiseInverse().asDiagonal() * v.transpose()) * units.asDiagonal(),
          per_unit.asDiagonal() * (v * missing.asDiagonal() * v.transpose()) * per_unit.asDiagonal()};
}

// From tangent space as Ceres has it to the report's coordinates.
Eigen::MatrixXd reportFromTangent(const Quantity& quantity, Eigen::Index size, const CalibrationState& state,
                                  ceres::Problem& problem) {
  if (quantity.kind == QuantityKind::CameraRotation) {
    return state.cameras[quantity.sensor].reference_from_camera.rotation.toRotationMatrix();
  }
  if (quantity.kind == QuantityKind::ImuRotation) {
    return state.imus[quantity.sensor].reference_from_imu.rotation.toRotationMatrix();
  }
  if (quantity.kind == QuantityKind::GravityDirection) {
    const Eigen::Vector3d& gravity = state.gravity_in_world_m_s2;
    const Eigen::Matrix<double, 2, 3> tilts = gravityTilts(gravity).transpose() / gravity.norm();
    if (size == 3) return (Eigen::Matrix3d() << tilts, gravity.normalized().transpose()).finished();
    Eigen::Matrix<double, 3, 2, Eigen::RowMajor> plus;
    problem.GetManifold(quantity.block)->PlusJacobian(quantity.block, plus.data());
    return tilts * plus;
  }
  return Eigen::MatrixXd::Identity(size, size);
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
    units.segment(first, count).setConstant(unitOf(information.quantities[i].kind));
    if (information.quantities[i].kind == QuantityKind::CameraIntrinsics)
      units.segment<4>(first).setConstant(kPixelUnit);
  }
  const SafeInverse safe = safeInverse(information.total, units);
  // What the data doesn't say of its own: priors, the floor under open directions, errors that repeat.
  Eigen::MatrixXd given = safe.open, measured = Eigen::MatrixXd::Zero(size, size);
  for (const MeasurementGroup& group : information.groups) {
    (group.kind == SensorKind::Prior ? given : measured) += group.variance() * group.information;
  }
  for (const Eigen::VectorXd& effect : information.pixel_errors) given += effect * effect.transpose();
  const Eigen::MatrixXd inverse = report_from_tangent * safe.inverse;
  Eigen::MatrixXd covariance = inverse * (measured + given) * inverse.transpose();
  const Eigen::MatrixXd correlated =
      inverse * (neweyWestByLag(information.scores, size, kLags) + given) * inverse.transpose();
  Eigen::VectorXd growth(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double asked = std::max(covariance(i, i), correlated(i, i));
    growth[i] = std::sqrt(std::max(1.0, asked / std::max(covariance(i, i), 1e-300)));
  }
  covariance = (growth.asDiagonal() * covariance * growth.asDiagonal()).eval();
  return {information.quantities, information.first_column, covariance};
}

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
constexpr std::array<const char*, 4> kPixelIntrinsics = {"focal_length.x", "focal_length.y",
                                                         "principal_point.x", "principal_point.y"};
constexpr std::array<const char*, 6> kMappingEntries = {"xx", "xy", "xz", "yy", "yz", "zz"};

struct Naming {
  const char* name;
  const char* unit;
};
Naming namingOf(QuantityKind kind) {
  switch (kind) {
    case QuantityKind::CameraRotation:
    case QuantityKind::ImuRotation:
      return {"rotation", "rad"};
    case QuantityKind::CameraTranslation:
    case QuantityKind::ImuTranslation:
      return {"translation", "m"};
    case QuantityKind::CameraTimeOffset:
    case QuantityKind::ImuTimeOffset:
      return {"time_offset", "s"};
    case QuantityKind::EdgeLead:
      return {"edge_lead", "px"};
    case QuantityKind::EdgeLeadGrowth:
      return {"edge_lead_growth", "px"};
    case QuantityKind::GyroscopeBias:
      return {"gyroscope_bias", "rad/s"};
    case QuantityKind::AccelerometerBias:
      return {"accelerometer_bias", "m/s^2"};
    case QuantityKind::GyroscopeMapping:
      return {"gyroscope_mapping", "1"};
    case QuantityKind::AccelerometerMapping:
      return {"accelerometer_mapping", "1"};
    case QuantityKind::CameraIntrinsics:
      return {"distortion", "1"};
    case QuantityKind::GyroscopeRotation:
      return {"gyroscope_rotation", "rad"};
    case QuantityKind::GravityDirection:
      break;
  }
  return {"direction", "rad"};
}

bool isCameraQuantity(QuantityKind kind) {
  return kind == QuantityKind::CameraRotation || kind == QuantityKind::CameraTranslation ||
         kind == QuantityKind::CameraTimeOffset || kind == QuantityKind::EdgeLead ||
         kind == QuantityKind::EdgeLeadGrowth || kind == QuantityKind::CameraIntrinsics;
}

// Those that are held stand at the end.
void appendIntrinsicsNames(const CameraData& camera, Eigen::Index size, std::vector<std::string>& names) {
  for (const char* name : kPixelIntrinsics) names.push_back(fmt::format("{}.{} [px]", camera.name, name));
  const auto coefficients = distortionNames(camera.intrinsics->model);
  const Naming naming = namingOf(QuantityKind::CameraIntrinsics);
  for (std::size_t k = 0; k + kPixelIntrinsics.size() < static_cast<std::size_t>(size); ++k)
    names.push_back(fmt::format("{}.{}.{} [{}]", camera.name, naming.name, coefficients[k], naming.unit));
}

void appendNames(const Quantity& quantity, Eigen::Index size, const CalibrationInput& input,
                 std::vector<std::string>& names) {
  if (quantity.kind == QuantityKind::CameraIntrinsics)
    return appendIntrinsicsNames(input.cameras[quantity.sensor], size, names);
  const Naming naming = namingOf(quantity.kind);
  const std::string sensor = quantity.kind == QuantityKind::GravityDirection ? "gravity"
                             : isCameraQuantity(quantity.kind) ? input.cameras[quantity.sensor].name
                                                               : input.imus[quantity.sensor].name;
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (quantity.kind == QuantityKind::GravityDirection && k == 2) {
      names.emplace_back("gravity.norm [m/s^2]");
      continue;
    }
    const std::string part = size == 1                                         ? ""
                             : quantity.kind == QuantityKind::GravityDirection ? fmt::format(".{}", k + 1)
                             : size == 3                                       ? fmt::format(".{}", kAxes[i])
                                         : fmt::format(".{}", kMappingEntries[i]);
    names.push_back(fmt::format("{}.{}{} [{}]", sensor, naming.name, part, naming.unit));
  }
}

Eigen::Matrix3d upperTriangle(const Eigen::VectorXd& row_by_row) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  matrix.row(0) = row_by_row.head<3>();
  matrix.row(1).tail<2>() = row_by_row.segment<2>(3);
  matrix(2, 2) = row_by_row[5];
  return matrix;
}

void storeStandardDeviations(const Quantity& quantity, const Eigen::VectorXd& sigma,
                             UncertaintyReport& report) {
  switch (quantity.kind) {
    case QuantityKind::CameraRotation:
      report.cameras[quantity.sensor].rotation_std_rad = sigma;
      break;
    case QuantityKind::CameraTranslation:
      report.cameras[quantity.sensor].translation_std_m = sigma;
      break;
    case QuantityKind::CameraTimeOffset:
      report.cameras[quantity.sensor].time_offset_std_s = sigma[0];
      break;
    case QuantityKind::EdgeLead:
      report.cameras[quantity.sensor].edge_lead_std_px = sigma[0];
      break;
    case QuantityKind::EdgeLeadGrowth:
      report.cameras[quantity.sensor].edge_lead_growth_std_px = sigma[0];
      break;
    case QuantityKind::CameraIntrinsics:
      std::copy(sigma.begin(), sigma.end(), report.cameras[quantity.sensor].intrinsics_std.emplace().begin());
      break;
    case QuantityKind::ImuRotation:
      report.imus[quantity.sensor].rotation_std_rad = sigma;
      break;
    case QuantityKind::ImuTranslation:
      report.imus[quantity.sensor].translation_std_m = sigma;
      break;
    case QuantityKind::ImuTimeOffset:
      report.imus[quantity.sensor].time_offset_std_s = sigma[0];
      break;
    case QuantityKind::GyroscopeBias:
      report.imus[quantity.sensor].gyroscope_bias_std_rad_s = sigma;
      break;
    case QuantityKind::AccelerometerBias:
      report.imus[quantity.sensor].accelerometer_bias_std_m_s2 = sigma;
      break;
    case QuantityKind::GyroscopeMapping:
      report.imus[quantity.sensor].gyroscope_mapping_std = upperTriangle(sigma);
      break;
    case QuantityKind::AccelerometerMapping:
      report.imus[quantity.sensor].accelerometer_mapping_std = upperTriangle(sigma);
      break;
    case QuantityKind::GyroscopeRotation:
      report.imus[quantity.sensor].gyroscope_rotation_std_rad = sigma;
      break;
    case QuantityKind::GravityDirection:
      report.gravity_direction_std_rad = sigma.head<2>().norm() / std::sqrt(2.0);
      if (sigma.size() == 3) report.gravity_norm_std_m_s2 = sigma[2];
      break;
  }
}

UncertaintyReport makeReport(const CalibrationInput& input, const QuantityCovariance& quantities) {
  UncertaintyReport report;
  report.cameras.resize(input.cameras.size());
  report.imus.resize(input.imus.size());
  report.standard_deviations = quantities.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = report.standard_deviations.cwiseMax(1e-300).cwiseInverse();
  report.correlation = inverse.asDiagonal() * quantities.covariance * inverse.asDiagonal();
  report.correlation.diagonal().setOnes();
  for (std::size_t i = 0; i < quantities.quantities.size(); ++i) {
    const Eigen::Index first = quantities.first_column[i], size = quantities.first_column[i + 1] - first;
    appendNames(quantities.quantities[i], size, input, report.names);
    storeStandardDeviations(quantities.quantities[i], report.standard_deviations.segment(first, size),
                            report);
  }
  return report;
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

UncertaintyEstimate estimateUncertainty(const CalibrationInput& input, const BatchSolution& solution,
                                        const OptimisationOptions& options, const RunContext& context) {
  context.throwIfStopped();
  // With gyroscopes free to turn, so that one that is turned is noticed where that is not estimated.
  OptimisationOptions free_to_turn = options;
  free_to_turn.gyroscope_rotation = true;
  CalibrationProblem problem(input, free_to_turn, solution.state);
  problem.build(lastStage(options),
                {solution.scales, solution.used_circles, std::vector<StillAxes>(input.imus.size())});
  ProjectedInformation information = projectInformation(problem, options.correlation_time_s, context);
  context.throwIfStopped();
  UncertaintyEstimate estimate;
  std::string turned;
  if (!options.gyroscope_rotation) {
    turned = turnedGyroscopes(input, information, withoutNoise(information), options);
    information = withoutGyroscopeRotation(std::move(information));
  }
  information = withoutNoise(std::move(information));
  const Eigen::MatrixXd report_from_tangent =
      reportFromTangent(information, solution.state, problem.problem());
  const QuantityCovariance covariance = quantityCovariance(information, report_from_tangent);
  estimate.report = makeReport(input, covariance);
  estimate.report.given = givenQuantities(input, options);
  const Eigen::MatrixXd tangent_from_report = report_from_tangent.inverse();
  reportDrift(information, problem.driftBlocks(),
              tangent_from_report * covariance.covariance * tangent_from_report.transpose(), estimate.report);
  const Observability observability = judgeObservability(input, solution.state, covariance, options);
  estimate.report.observability = observability.eigenvalues;
  estimate.report.weakest = observability.weakest;
  estimate.status = observability.status;
  estimate.reason = observability.reason;
  addDoubt(turned, estimate);
  return estimate;
}

}  // namespace evical
