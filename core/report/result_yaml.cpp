#include "core/report/result_yaml.h"

#include "core/base/element.h"
#include "core/base/yaml_node.h"
#include "core/data/intrinsics_yaml.h"
#include "core/numerics/angles.h"
#include "core/report/intrinsics_report.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {
namespace {

// Values are written so that they read back the same; sigmas need no more than a few digits.
std::string exact(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0.0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}
std::string rounded(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : exact(value);
}

template <class Vector, class Format>
std::string list(const Vector& values, Format&& format) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + format(value);
  return "[" + text + "]";
}
std::string matrix(const Eigen::MatrixXd& m, std::string (*format)(double)) {
  std::string text;
  for (Eigen::Index row = 0; row < m.rows(); ++row)
    text += (row == 0 ? "" : ", ") + list(Eigen::VectorXd(m.row(row)), format);
  return "[" + text + "]";
}

std::string transformYaml(const char* key, const RigidTransform& pose,
                          const Eigen::Vector3d& rotation_std_rad, const Eigen::Vector3d& translation_std_m) {
  return fmt::format(
      "    {}:\n      rotation_xyzw: {}\n      translation_m: {}\n      rotation_std_deg: {}\n"
      "      translation_std_m: {}\n",
      key, list(pose.rotation.coeffs(), exact), list(pose.translation_m, exact),
      list(Eigen::Vector3d(kDegPerRad * rotation_std_rad), rounded), list(translation_std_m, rounded));
}

// The i-th of a list that may be shorter than it should: nothing known.
std::string streamYaml(const std::string& stream) {
  return stream.empty() ? "" : fmt::format("    stream: {}\n", yamlText(stream));
}

std::string cameraYaml(const NamedResult& named, std::size_t i) {
  const CameraState& state = named.result.state.cameras[i];
  const CameraUncertainty sigma = elementOrNone(named.result.uncertainty.cameras, i);
  const CameraFit fit = elementOrNone(named.result.cameras, i);
  std::string text = fmt::format("  {}:\n", yamlText(named.names.cameras.at(i)));
  text += streamYaml(elementOrNone(named.names.camera_streams, i));
  text += transformYaml("reference_from_camera", state.reference_from_camera, sigma.rotation_std_rad,
                        sigma.translation_std_m);
  text += fmt::format(
      "    time_offset_s: {}\n    time_offset_std_s: {}\n    edge_lead_px: {}\n    edge_lead_std_px: {}\n"
      "    edge_lead_growth_px: {}\n    edge_lead_growth_std_px: {}\n",
      exact(state.time_offset_s), rounded(sigma.time_offset_std_s), exact(state.edge_lead_px),
      rounded(sigma.edge_lead_std_px), exact(state.edge_lead_growth_px),
      rounded(sigma.edge_lead_growth_std_px));
  if (const auto intrinsics = elementOrNone(named.names.intrinsics, i)) {
    text += "    intrinsics:\n" + intrinsicsYaml(*intrinsics, 6);
    if (const auto sigmas = elementOrNone(named.names.intrinsics_std, i))
      text += "    intrinsics_std:\n" + intrinsicsStdYaml(*intrinsics, *sigmas, 6);
  }
  text += fmt::format("    reprojection_rms_px: {}\n    normalised_rms: {}\n",
                      rounded(fit.reprojection_rms_px), rounded(fit.normalised_rms));
  text += fmt::format(
      "    windows: {{total: {}, complete: {}, partial: {}, used: {}}}\n    circles: {{used: {}, rejected: "
      "{}}}\n",
      fit.windows_total, fit.windows_complete, fit.windows_partial, fit.windows_used, fit.circles_used,
      fit.circles_rejected);
  return text;
}

std::string inertialYaml(const char* key, const char* unit, const Eigen::Vector3d& bias,
                         const Eigen::Vector3d& bias_std, const Eigen::Matrix3d& mapping,
                         const Eigen::Matrix3d& mapping_std, double rms) {
  return fmt::format(
      "    {}:\n      bias_{}: {}\n      bias_std_{}: {}\n      mapping: {}\n      mapping_std: {}\n"
      "      residual_rms_{}: {}\n",
      key, unit, list(bias, exact), unit, list(bias_std, rounded), matrix(mapping, exact),
      matrix(mapping_std, rounded), unit, rounded(rms));
}

std::string knownYaml(const KnownOfImu& known) {
  std::string text = streamYaml(known.stream);
  const auto add = [&](const char* key, double value) {
    if (value > 0.0) text += fmt::format("    {}: {}\n", key, exact(value));
  };
  if (known.noise) {
    add("accelerometer_noise_density", known.noise->accelerometer_density);
    add("gyroscope_noise_density", known.noise->gyroscope_density);
  }
  add("accelerometer_random_walk", known.accelerometer_random_walk);
  add("gyroscope_random_walk", known.gyroscope_random_walk);
  add("rate_hz", known.rate_hz);
  return text;
}

std::string imuYaml(const NamedResult& named, std::size_t i) {
  const ImuState& state = named.result.state.imus[i];
  const ImuUncertainty sigma = elementOrNone(named.result.uncertainty.imus, i);
  const ImuFit fit = elementOrNone(named.result.imus, i);
  std::string text = fmt::format("  {}:\n", yamlText(named.names.imus.at(i)));
  text += knownYaml(elementOrNone(named.names.known_of_imus, i));
  text += transformYaml("reference_from_imu", state.reference_from_imu, sigma.rotation_std_rad,
                        sigma.translation_std_m);
  text += fmt::format("    time_offset_s: {}\n    time_offset_std_s: {}\n", exact(state.time_offset_s),
                      rounded(sigma.time_offset_std_s));
  text += inertialYaml("gyroscope", "rad_s", state.gyroscope_bias_rad_s, sigma.gyroscope_bias_std_rad_s,
                       state.gyroscope_mapping, sigma.gyroscope_mapping_std, fit.gyroscope_rms_rad_s);
  text += fmt::format("      gyroscope_from_accelerometer_xyzw: {}\n      rotation_std_deg: {}\n",
                      list(state.gyroscope_from_accelerometer.coeffs(), exact),
                      list(Eigen::Vector3d(kDegPerRad * sigma.gyroscope_rotation_std_rad), rounded));
  text +=
      inertialYaml("accelerometer", "m_s2", state.accelerometer_bias_m_s2, sigma.accelerometer_bias_std_m_s2,
                   state.accelerometer_mapping, sigma.accelerometer_mapping_std, fit.accelerometer_rms_m_s2);
  return text;
}

std::string uncertaintyYaml(const UncertaintyReport& uncertainty) {
  std::string text =
      fmt::format("gravity_direction_std_deg: {}\nobservability:\n  weakest: {}\n  values: {}\n",
                  rounded(kDegPerRad * uncertainty.gravity_direction_std_rad), yamlText(uncertainty.weakest),
                  list(uncertainty.observability, rounded));
  if (uncertainty.gravity_norm_std_m_s2 > 0.0)
    text += fmt::format("gravity_norm_std_m_s2: {}\n", rounded(uncertainty.gravity_norm_std_m_s2));
  if (!uncertainty.given.empty()) {
    text += "given:\n";
    for (const std::string& quantity : uncertainty.given) text += fmt::format("  - {}\n", yamlText(quantity));
  }
  if (uncertainty.names.empty()) return text;
  text += "uncertainty:\n  names:\n";
  for (const std::string& name : uncertainty.names) text += fmt::format("    - {}\n", yamlText(name));
  text += fmt::format("  std: {}\n  correlation:\n", list(uncertainty.standard_deviations, rounded));
  const auto fourDecimals = [](double value) { return rounded(std::round(value * 1e4) / 1e4); };
  for (Eigen::Index row = 0; row < uncertainty.correlation.rows(); ++row)
    text += fmt::format("    - {}\n", list(Eigen::VectorXd(uncertainty.correlation.row(row)), fourDecimals));
  return text;
}

std::string crossValidationYaml(const CrossValidation& validation) {
  std::string text = fmt::format("cross_validation:\n  block_s: {}\n  windows: [{}, {}]\n",
                                 rounded(validation.block_s), validation.windows[0], validation.windows[1]);
  if (!validation.failure.empty()) return text + fmt::format("  failure: {}\n", yamlText(validation.failure));
  text += fmt::format("  rms_sigmas: {}\n  differences:\n", rounded(validation.rms_sigmas));
  for (const HalvesDifference& each : validation.quantities)
    text += fmt::format("    - {{name: {}, unit: {}, difference: {}, std: {}}}\n", yamlText(each.name),
                        yamlText(each.unit), rounded(each.difference), rounded(each.sigma));
  return text;
}

std::string runYaml(const NamedResult& named) {
  const Timing& timing = named.result.timing;
  std::string text = named.result.notes.empty() ? "notes: []\n" : "notes:\n";
  for (const std::string& note : named.result.notes) text += fmt::format("  - {}\n", yamlText(note));
  text += fmt::format(
      "timing_s: {{read: {:.3f}, detect: {:.3f}, initialise: {:.3f}, optimise: {:.3f}, cross_validate: "
      "{:.3f}, "
      "total: {:.3f}}}\n",
      timing.read_s, timing.detect_s, timing.initialise_s, timing.optimise_s, timing.cross_validate_s,
      timing.total_s);
  text += fmt::format("memory_peak_mb: {:.0f}\nprogram:\n  version: {}\n", named.result.memory_peak_mb,
                      yamlText(named.names.version));
  text += named.names.options.empty() ? "  options: {}\n" : "  options:\n";
  for (const OptionRow& row : named.names.options) text += fmt::format("    {}: {}\n", row.name, row.value);
  return text;
}

}  // namespace

const char* statusName(CalibrationStatus status) {
  if (status == CalibrationStatus::Ok) return "ok";
  return status == CalibrationStatus::Doubtful ? "doubtful" : "failed";
}

std::string resultYaml(const NamedResult& named) {
  const CalibrationState& state = named.result.state;
  std::string text = fmt::format("evical_result: 1\nstatus: {}\nreason: {}\nreference: {}\n",
                                 statusName(named.result.status), yamlText(named.result.reason),
                                 yamlText(named.names.reference));
  if (named.result.start_ns) text += fmt::format("recording:\n  start_ns: {}\n", *named.result.start_ns);
  text += state.cameras.empty() ? "cameras: {}\n" : "cameras:\n";
  for (std::size_t i = 0; i < state.cameras.size(); ++i) text += cameraYaml(named, i);
  text += state.imus.empty() ? "imus: {}\n" : "imus:\n";
  for (std::size_t i = 0; i < state.imus.size(); ++i) text += imuYaml(named, i);
  if (!state.imus.empty())
    text += fmt::format("gravity_m_s2: {}\n", list(state.gravity_in_world_m_s2, exact));
  text += uncertaintyYaml(named.result.uncertainty);
  if (named.result.cross_validation) text += crossValidationYaml(*named.result.cross_validation);
  return text + runYaml(named);
}

}  // namespace evical
