#include "core/report/truth_comparison.h"

#include "core/base/element.h"
#include "core/base/nearest_name.h"
#include "core/data/intrinsics_result.h"
#include "core/geometry/intrinsics_numbers.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kMmPerM = 1e3, kMsPerS = 1e3;

std::size_t indexOf(const std::string& name, const std::vector<std::string>& names, const char* key) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw badInput(key, fmt::format("the truth has no '{}'", name), nameAdvice(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

class Errors {
 public:
  explicit Errors(std::vector<QuantityError>& all) : all_(all) {}

  void add(const std::string& name, const char* unit, double error, double sigma, double factor = 1.0) {
    all_.push_back({name, unit, factor * error, factor * sigma});
  }
  void add(const std::string& name, const char* unit, const Eigen::Vector3d& error,
           const Eigen::Vector3d& sigma, double factor = 1.0) {
    for (int axis = 0; axis < 3; ++axis)
      add(fmt::format("{}.{}", name, "xyz"[axis]), unit, error[axis], sigma[axis], factor);
  }
  // Upper triangle: what is estimated.
  void add(const std::string& name, const Eigen::Matrix3d& error, const Eigen::Matrix3d& sigma) {
    for (int row = 0; row < 3; ++row)
      for (int col = row; col < 3; ++col)
        add(fmt::format("{}.{}{}", name, "xyz"[row], "xyz"[col]), "", error(row, col), sigma(row, col));
  }

 private:
  std::vector<QuantityError>& all_;
};

Eigen::Vector3d rotationError_rad(const RigidTransform& estimate, const RigidTransform& truth) {
  return quaternionLog(estimate.rotation * truth.rotation.conjugate());
}

CameraError compareCamera(const std::string& name, const CameraState& estimate, const CameraState& truth,
                          const CameraUncertainty& sigma, Errors& errors) {
  const Eigen::Vector3d rotation_rad =
      rotationError_rad(estimate.reference_from_camera, truth.reference_from_camera);
  const Eigen::Vector3d translation_m =
      estimate.reference_from_camera.translation_m - truth.reference_from_camera.translation_m;
  const double time_s = estimate.time_offset_s - truth.time_offset_s;
  errors.add(name + ".rotation", "deg", rotation_rad, sigma.rotation_std_rad, kDegPerRad);
  errors.add(name + ".translation", "mm", translation_m, sigma.translation_std_m, kMmPerM);
  errors.add(name + ".time_offset", "ms", time_s, sigma.time_offset_std_s, kMsPerS);
  return {name, kDegPerRad * rotation_rad.norm(), kMmPerM * translation_m.norm(), kMsPerS * std::abs(time_s)};
}

// Where they were calibrated; another model's coefficients mean something else.
void compareIntrinsics(const ResultNames& estimate, std::size_t i, const ResultNames& truth, std::size_t j,
                       Errors& errors) {
  const auto found = elementOrNone(estimate.intrinsics, i), actual = elementOrNone(truth.intrinsics, j);
  const auto sigmas = elementOrNone(estimate.intrinsics_std, i);
  if (!found || !actual || !sigmas || found->model != actual->model) return;
  const std::string& name = estimate.cameras[i];
  for (int axis = 0; axis < 2; ++axis)
    errors.add(fmt::format("{}.focal_length.{}", name, "xy"[axis]), "px",
               found->focal_length_px[axis] - actual->focal_length_px[axis],
               (*sigmas)[static_cast<std::size_t>(axis)]);
  for (int axis = 0; axis < 2; ++axis)
    errors.add(fmt::format("{}.principal_point.{}", name, "xy"[axis]), "px",
               found->principal_point_px[axis] - actual->principal_point_px[axis],
               (*sigmas)[static_cast<std::size_t>(axis) + 2]);
  const auto coefficients = distortionNames(found->model);
  for (std::size_t k = 0; k < static_cast<std::size_t>(distortionCount(*found)); ++k)
    errors.add(fmt::format("{}.distortion.{}", name, coefficients[k]), "",
               found->distortion[k] - actual->distortion[k], (*sigmas)[k + 4]);
}

bool turnsGyroscope(const ImuState& imu) {
  return imu.gyroscope_from_accelerometer.vec() != Eigen::Vector3d::Zero();
}

void compareImu(const std::string& name, const ImuState& estimate, const ImuState& truth,
                const ImuUncertainty& sigma, bool reference, Errors& errors) {
  if (!reference) {
    errors.add(name + ".rotation", "deg",
               rotationError_rad(estimate.reference_from_imu, truth.reference_from_imu),
               sigma.rotation_std_rad, kDegPerRad);
    errors.add(name + ".translation", "mm",
               estimate.reference_from_imu.translation_m - truth.reference_from_imu.translation_m,
               sigma.translation_std_m, kMmPerM);
    errors.add(name + ".time_offset", "ms", estimate.time_offset_s - truth.time_offset_s,
               sigma.time_offset_std_s, kMsPerS);
  }
  errors.add(name + ".gyroscope_bias", "rad/s", estimate.gyroscope_bias_rad_s - truth.gyroscope_bias_rad_s,
             sigma.gyroscope_bias_std_rad_s);
  errors.add(name + ".accelerometer_bias", "m/s^2",
             estimate.accelerometer_bias_m_s2 - truth.accelerometer_bias_m_s2,
             sigma.accelerometer_bias_std_m_s2);
  errors.add(name + ".gyroscope_mapping", estimate.gyroscope_mapping - truth.gyroscope_mapping,
             sigma.gyroscope_mapping_std);
  if (turnsGyroscope(estimate) || turnsGyroscope(truth))
    errors.add(
        name + ".gyroscope_rotation", "deg",
        quaternionLog(truth.gyroscope_from_accelerometer.conjugate() * estimate.gyroscope_from_accelerometer),
        sigma.gyroscope_rotation_std_rad, kDegPerRad);
  errors.add(name + ".accelerometer_mapping", estimate.accelerometer_mapping - truth.accelerometer_mapping,
             sigma.accelerometer_mapping_std);
}

}  // namespace

double TruthComparison::normalisedRms() const {
  double sum = 0.0;
  int count = 0;
  for (const QuantityError& quantity : quantities) {
    if (!(quantity.sigma > 0.0)) continue;
    sum += quantity.normalised() * quantity.normalised();
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(sum / count);
}

TruthComparison compareWithTruth(const NamedResult& result, const NamedResult& truth) {
  if (result.names.reference != truth.names.reference)
    throw badInput(
        "reference",
        fmt::format("the result's is '{}', the truth's '{}'", result.names.reference, truth.names.reference),
        "Compare a result with the truth of its own recording");
  TruthComparison comparison;
  Errors errors(comparison.quantities);
  const UncertaintyReport& sigma = result.result.uncertainty;
  for (std::size_t i = 0; i < result.names.cameras.size(); ++i) {
    const std::string& name = result.names.cameras[i];
    const std::size_t j = indexOf(name, truth.names.cameras, "cameras");
    comparison.cameras.push_back(compareCamera(name, result.result.state.cameras.at(i),
                                               truth.result.state.cameras.at(j),
                                               elementOrNone(sigma.cameras, i), errors));
    compareIntrinsics(result.names, i, truth.names, j, errors);
  }
  for (std::size_t i = 0; i < result.names.imus.size(); ++i) {
    const std::string& name = result.names.imus[i];
    const std::size_t j = indexOf(name, truth.names.imus, "imus");
    compareImu(name, result.result.state.imus.at(i), truth.result.state.imus.at(j),
               elementOrNone(sigma.imus, i), name == result.names.reference, errors);
  }
  if (sigma.gravity_norm_std_m_s2 > 0.0)
    errors.add(
        "gravity.norm", "m/s^2",
        result.result.state.gravity_in_world_m_s2.norm() - truth.result.state.gravity_in_world_m_s2.norm(),
        sigma.gravity_norm_std_m_s2);
  const Eigen::Vector3d estimate = result.result.state.gravity_in_world_m_s2.normalized();
  const Eigen::Vector3d actual = truth.result.state.gravity_in_world_m_s2.normalized();
  comparison.gravity_direction_deg =
      kDegPerRad * std::atan2(estimate.cross(actual).norm(), estimate.dot(actual));
  return comparison;
}

std::string comparisonTable(const TruthComparison& comparison) {
  std::string text = fmt::format("{:<40}{:>14}{:>14}{:>14}\n", "quantity", "error", "sigma", "error/sigma");
  for (const QuantityError& q : comparison.quantities) {
    const std::string name = q.unit.empty() ? q.name : fmt::format("{} [{}]", q.name, q.unit);
    text += q.sigma > 0.0
                ? fmt::format("{:<40}{:>14.6f}{:>14.6f}{:>14.2f}\n", name, q.error, q.sigma, q.normalised())
                : fmt::format("{:<40}{:>14.6f}{:>14}{:>14}\n", name, q.error, "-", "-");
  }
  text += fmt::format("{:<40}{:>14.6f}\n", "gravity direction [deg]", comparison.gravity_direction_deg);
  for (const CameraError& camera : comparison.cameras)
    text +=
        fmt::format("{}: rotation off by {:.4f} deg, translation by {:.3f} mm, time offset by {:.4f} ms\n",
                    camera.name, camera.rotation_deg, camera.translation_mm, camera.time_offset_ms);
  return text + fmt::format("normalised errors: RMS {:.2f} (1 where the sigmas are honest)\n",
                            comparison.normalisedRms());
}

}  // namespace evical
