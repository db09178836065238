#include "core/report/result_table.h"

#include "core/base/element.h"
#include "core/numerics/angles.h"
#include "core/report/intrinsics_report.h"
#include "core/report/table_row.h"

#include "core/geometry/so3.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// The i-th of a list that is empty where a run failed: nothing known.
std::string vectorRows(const std::string& name, const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
                       const char* unit, double factor, int decimals = 5) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += tableRow(fmt::format("{} {}", name, "xyz"[axis]), factor * value[axis], factor * sigma[axis],
                     unit, decimals);
  return text;
}

std::string poseRows(const RigidTransform& pose, const Eigen::Vector3d& rotation_std_rad,
                     const Eigen::Vector3d& translation_std_m) {
  std::string text = vectorRows("rotation vector", kDegPerRad * quaternionLog(pose.rotation),
                                kDegPerRad * rotation_std_rad, "deg", 1.0);
  const Eigen::Vector3d angles = rollPitchYaw_deg(pose.rotation);
  text += fmt::format("    {:<26}{:>12.3f}, {:.3f}, {:.3f} deg\n", "(roll, pitch, yaw)", angles.x(),
                      angles.y(), angles.z());
  return text + vectorRows("translation", pose.translation_m, translation_std_m, "mm", 1e3, 4);
}

std::string givenRow(const NamedResult& named, const std::string& sensor) {
  const std::string given = givenOf(named.result.uncertainty, sensor);
  return given.empty() ? "" : fmt::format("    {:<26}{}\n", "given, not estimated", given);
}

std::string cameraTable(const NamedResult& named, std::size_t i) {
  const CameraState& state = named.result.state.cameras[i];
  const CameraUncertainty sigma = elementOrNone(named.result.uncertainty.cameras, i);
  std::string text = fmt::format("Camera {}: p_{} = reference_from_camera * p_camera\n",
                                 named.names.cameras.at(i), named.names.reference);
  text += poseRows(state.reference_from_camera, sigma.rotation_std_rad, sigma.translation_std_m);
  text += tableRow("time offset", 1e3 * state.time_offset_s, 1e3 * sigma.time_offset_std_s,
                   "ms  (t_reference = t_camera + it)");
  text += tableRow("edge lead", state.edge_lead_px, sigma.edge_lead_std_px, "px at 100 px/s", 4);
  text += tableRow("edge lead growth", state.edge_lead_growth_px, sigma.edge_lead_growth_std_px,
                   "px for each factor e of speed", 4);
  text += givenRow(named, named.names.cameras[i]);
  if (const auto sigmas = elementOrNone(named.names.intrinsics_std, i))
    text += intrinsicsRows(elementOrNone(named.names.intrinsics, i).value_or(CameraIntrinsics{}), *sigmas);
  if (i >= named.result.cameras.size()) return text;
  const CameraFit& fit = named.result.cameras[i];
  text += fmt::format("    {:<26}{:>12.4f} px RMS, {:.2f} of what its sigmas say\n", "reprojection",
                      fit.reprojection_rms_px, fit.normalised_rms);
  const int found = fit.windows_complete + fit.windows_partial;
  return text + fmt::format("    {:<26}{:>12} of {} with the board ({} complete, {} partial), {} used\n",
                            "windows", found, fit.windows_total, fit.windows_complete, fit.windows_partial,
                            fit.windows_used);
}

std::string imuTable(const NamedResult& named, std::size_t i) {
  const ImuState& state = named.result.state.imus[i];
  const ImuUncertainty sigma = elementOrNone(named.result.uncertainty.imus, i);
  const bool reference = named.names.imus.at(i) == named.names.reference;
  std::string text = fmt::format("IMU {}{}\n", named.names.imus[i], reference ? " (reference)" : "");
  if (!reference) {
    text += poseRows(state.reference_from_imu, sigma.rotation_std_rad, sigma.translation_std_m);
    text += tableRow("time offset", 1e3 * state.time_offset_s, 1e3 * sigma.time_offset_std_s, "ms");
  }
  text += vectorRows("gyroscope bias", state.gyroscope_bias_rad_s, sigma.gyroscope_bias_std_rad_s, "rad/s",
                     1.0, 6);
  text += vectorRows("accelerometer bias", state.accelerometer_bias_m_s2, sigma.accelerometer_bias_std_m_s2,
                     "m/s^2", 1.0);
  for (int axis = 0; axis < 3; ++axis)
    text += tableRow(fmt::format("gyroscope scale {}", "xyz"[axis]), state.gyroscope_mapping(axis, axis),
                     sigma.gyroscope_mapping_std(axis, axis), "", 6);
  if (sigma.gyroscope_rotation_std_rad.norm() > 0.0)
    text +=
        vectorRows("gyroscope turn", kDegPerRad * quaternionLog(state.gyroscope_from_accelerometer),
                   kDegPerRad * sigma.gyroscope_rotation_std_rad, "deg  (gyroscope from accelerometer)", 1.0);
  for (int axis = 0; axis < 3; ++axis)
    text +=
        tableRow(fmt::format("accelerometer scale {}", "xyz"[axis]), state.accelerometer_mapping(axis, axis),
                 sigma.accelerometer_mapping_std(axis, axis), "", 6);
  text += givenRow(named, named.names.imus[i]);
  if (i >= named.result.imus.size()) return text;
  const ImuFit& fit = named.result.imus[i];
  return text + fmt::format("    {:<26}{:>12.5f} rad/s and {:.4f} m/s^2 RMS\n", "residuals",
                            fit.gyroscope_rms_rad_s, fit.accelerometer_rms_m_s2);
}

std::string verdict(const CalibrationResult& result) {
  std::string text = fmt::format("Verdict: {}", statusName(result.status));
  if (!result.reason.empty()) text += fmt::format(" - {}", result.reason);
  text += "\n";
  if (!result.uncertainty.weakest.empty()) text += fmt::format("Weakest: {}\n", result.uncertainty.weakest);
  for (const std::string& note : result.notes) text += fmt::format("Note: {}\n", note);
  return text;
}

}  // namespace

std::string givenOf(const UncertaintyReport& uncertainty, const std::string& sensor) {
  std::string words;
  for (const std::string& quantity : uncertainty.given) {
    if (!quantity.starts_with(sensor + ".")) continue;
    std::string name = quantity.substr(sensor.size() + 1);
    std::replace(name.begin(), name.end(), '_', ' ');
    words += (words.empty() ? "" : ", ") + name;
  }
  return words;
}

Eigen::Vector3d rollPitchYaw_deg(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  return kDegPerRad * Eigen::Vector3d(std::atan2(r(2, 1), r(2, 2)),
                                      std::asin(std::clamp(-r(2, 0), -1.0, 1.0)),
                                      std::atan2(r(1, 0), r(0, 0)));
}

std::string resultTable(const NamedResult& named) {
  std::string text;
  for (std::size_t i = 0; i < named.result.state.cameras.size(); ++i) text += cameraTable(named, i);
  for (std::size_t i = 0; i < named.result.state.imus.size(); ++i) text += imuTable(named, i);
  if (!named.result.state.imus.empty()) {
    const Eigen::Vector3d& g = named.result.state.gravity_in_world_m_s2;
    text +=
        fmt::format("Gravity in the board's frame: {:.4f}, {:.4f}, {:.4f} m/s^2 (direction +- {:.4f} deg)\n",
                    g.x(), g.y(), g.z(), kDegPerRad * named.result.uncertainty.gravity_direction_std_rad);
    if (const double sigma = named.result.uncertainty.gravity_norm_std_m_s2; sigma > 0.0)
      text += tableRow("gravity's norm", g.norm(), sigma, "m/s^2");
  }
  const Timing& t = named.result.timing;
  text += fmt::format(
      "Time: {:.1f} s (read {:.1f}, detect {:.1f}, initialise {:.1f}, optimise {:.1f}); memory {:.0f} MB\n",
      t.total_s, t.read_s, t.detect_s, t.initialise_s, t.optimise_s, named.result.memory_peak_mb);
  return text + verdict(named.result);
}

}  // namespace evical
