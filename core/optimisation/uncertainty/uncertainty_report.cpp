#include "core/optimisation/uncertainty/uncertainty_report.h"

#include "core/geometry/intrinsics_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

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

}  // namespace

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

}  // namespace evical
