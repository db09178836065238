#include "core/report/result_table.h"

#include "core/report/intrinsics_report.h"
#include "core/report/shown_quantity.h"

#include "core/base/element.h"
#include "core/base/number.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

std::string anglesRow(const Eigen::Quaterniond& rotation) {
  const Eigen::Vector3d angles = rollPitchYaw_deg(rotation);
  const std::string warning = anglesWarning(angles);
  std::string text =
      fmt::format("    {:<26}{:>12.3f}, {:.3f}, {:.3f} deg{}\n", "(roll, pitch, yaw)", angles.x(), angles.y(),
                  angles.z(), warning.empty() ? "" : " (" + warning + ")");
  if (!warning.empty())
    text += fmt::format("    {:<26}{:>12.6f}, {:.6f}, {:.6f}, {:.6f}\n", "(quaternion x, y, z, w)",
                        rotation.x(), rotation.y(), rotation.z(), rotation.w());
  return text;
}

// For a matrix only the scales: misalignments are in result.yaml.
std::string quantityRows(const ShownQuantity& quantity) {
  std::string text;
  for (const ShownNumber& number : quantity.numbers) {
    std::string name = quantity.info->title;
    if (quantity.info->shape == QuantityShape::UpperTriangle) {
      if (!isScale(number)) continue;
      name += fmt::format(" scale {}", number.part[0]);
    } else if (!number.part.empty()) {
      name += " " + number.part;
    }
    text +=
        tableRow(name, number.value, number.sigma, unitAndRemark(quantity).c_str(), quantity.info->decimals);
  }
  return text;
}

// Rows of a sensor, with roll, pitch and yaw below the rotation to the reference.
std::string sensorRows(const std::vector<ShownQuantity>& quantities, const Eigen::Quaterniond& rotation) {
  std::string text;
  for (const ShownQuantity& quantity : quantities) {
    if (quantity.info->shape == QuantityShape::Intrinsics) continue;
    text += quantityRows(quantity);
    if (quantity.info->shape == QuantityShape::Rotation) text += anglesRow(rotation);
  }
  return text;
}

std::string givenRow(const NamedResult& named, const std::string& sensor) {
  const std::string given = givenOf(named.result->uncertainty, sensor);
  return given.empty() ? "" : fmt::format("    {:<26}{}\n", "given, not estimated", given);
}

std::string cameraTable(const NamedResult& named, std::size_t i) {
  const CameraState& state = named.result->state.cameras[i];
  std::string text =
      fmt::format("Camera {0}: p_{1} = reference_from_camera * p_camera, t_{1} = t_camera + time offset\n",
                  named.cameras.at(i).name, named.reference);
  text += sensorRows(shownCamera(named, i), state.reference_from_camera.rotation);
  text += givenRow(named, named.cameras[i].name);
  if (const auto sigmas = elementOrNone(named.result->uncertainty.cameras, i).intrinsics_std)
    text += intrinsicsRows(state.lens.inUse().value_or(CameraIntrinsics{}), *sigmas);
  if (i >= named.result->cameras.size()) return text;
  const CameraFit& fit = named.result->cameras[i];
  text += fmt::format("    {:<26}{:>12.4f} px RMS, {:.2f} times its sigmas\n", "reprojection",
                      fit.reprojection_rms_px, fit.normalised_rms);
  if (fit.neighbour_agreement > 0.0)
    text += fmt::format("    {:<26}{:>12.2f} correlation of neighbouring points in a window\n",
                        "errors agree", fit.neighbour_agreement);
  const int found = fit.windows_complete + fit.windows_partial;
  return text +
         fmt::format(
             "    {:<26}{:>12} of {} with the board ({} complete, {} partial), {} used{}\n", "windows", found,
             fit.windows_total, fit.windows_complete, fit.windows_partial, fit.windows_used,
             fit.windows_rejected > 0 ? fmt::format(", {} rejected by hand", fit.windows_rejected) : "");
}

std::string imuTable(const NamedResult& named, std::size_t i) {
  const ImuState& state = named.result->state.imus[i];
  const bool reference = named.imus.at(i).name == named.reference;
  std::string text = fmt::format("IMU {}{}\n", named.imus[i].name, reference ? " (reference)" : "");
  text += sensorRows(shownImu(named, i, !reference), state.reference_from_imu.rotation);
  text += givenRow(named, named.imus[i].name);
  if (i >= named.result->imus.size()) return text;
  const ImuFit& fit = named.result->imus[i];
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
  for (std::size_t i = 0; i < named.result->state.cameras.size(); ++i) text += cameraTable(named, i);
  for (std::size_t i = 0; i < named.result->state.imus.size(); ++i) text += imuTable(named, i);
  for (std::size_t i = 0; i < named.boards.size(); ++i) {
    const std::vector<ShownQuantity> board = shownBoard(named, i);
    if (board.empty()) continue;
    text += boardTitle(named, i) + "\n";
    text += sensorRows(board, named.result->state.boardAt(i).world_from_board.rotation);
  }
  if (!named.result->state.imus.empty()) {
    const Eigen::Vector3d& g = named.result->state.gravity_in_world_m_s2;
    text +=
        fmt::format("Gravity in the board's frame: {:.4f}, {:.4f}, {:.4f} m/s^2 (direction +- {:.4f} deg)\n",
                    g.x(), g.y(), g.z(), kDegPerRad * named.result->uncertainty.gravity_direction_std_rad);
    if (const double sigma = named.result->uncertainty.gravity_norm_std_m_s2; sigma > 0.0)
      text += tableRow("gravity's norm", g.norm(), sigma, "m/s^2");
  }
  const Timing& t = named.result->timing;
  text += fmt::format(
      "Time: {:.1f} s (read {:.1f}, detect {:.1f}, initialise {:.1f}, optimise {:.1f}); memory {:.0f} MB\n",
      t.total_s, t.read_s, t.detect_s, t.initialise_s, t.optimise_s, named.result->memory_peak_mb);
  return text + verdict(*named.result);
}

std::string tableRow(const std::string& name, double value, double sigma, const char* unit, int most) {
  const int decimals = decimalsFor(sigma, most, most);
  const std::string shown =
      sigma > 0.0 ? fmt::format("+- {:<10.{}f}", sigma, decimals) : std::string(13, ' ');
  return fmt::format("    {:<26}{:>12.{}f} {} {}\n", name, value, decimals, shown, unit);
}

}  // namespace evical
