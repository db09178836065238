#include "core/report/result_yaml.h"

#include "core/base/yaml_node.h"
#include "core/data/intrinsics_yaml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>

namespace evical {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

// Estimates exactly, their uncertainties to six digits: more would be noise.
constexpr const char* kEstimate = "{}";
constexpr const char* kSigma = "{:.6g}";

std::string list(const Eigen::Ref<const Eigen::VectorXd>& values, const char* format) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < values.size(); ++i)
    text += (i == 0 ? "" : ", ") + fmt::format(fmt::runtime(format), values[i]);
  return text + "]";
}

std::string rows(const Eigen::Matrix3d& m, const char* format) {
  return fmt::format("[{}, {}, {}]", list(m.row(0).transpose(), format), list(m.row(1).transpose(), format),
                     list(m.row(2).transpose(), format));
}

std::string transformYaml(const char* key, const RigidTransform& transform,
                          const Eigen::Vector3d& rotation_std_rad, const Eigen::Vector3d& translation_std_m) {
  return fmt::format(
      "    {}:\n      rotation_xyzw: {}\n      translation_m: {}\n      rotation_std_deg: {}\n"
      "      translation_std_m: {}\n",
      key, list(transform.rotation.coeffs(), kEstimate), list(transform.translation_m, kEstimate),
      list(rotation_std_rad * kDegPerRad, kSigma), list(translation_std_m, kSigma));
}

std::string cameraYaml(const DocumentedCamera& camera) {
  const CameraFit& fit = camera.fit;
  std::string text = fmt::format("  {}:\n", yamlText(camera.name));
  text += transformYaml("reference_from_camera", camera.state.imu_from_camera,
                        camera.uncertainty.rotation_std_rad, camera.uncertainty.translation_std_m);
  text += fmt::format("    time_offset_s: {}\n    time_offset_std_s: {:.6g}\n", camera.state.time_offset_s,
                      camera.uncertainty.time_offset_std_s);
  text += fmt::format("    edge_lead_px: {}\n    edge_lead_std_px: {:.6g}\n", camera.state.edge_lead_px,
                      camera.uncertainty.edge_lead_std_px);
  if (camera.intrinsics) text += "    intrinsics:\n" + intrinsicsYaml(*camera.intrinsics, 6);
  text += fmt::format("    reprojection_rms_px: {:.6g}\n    normalised_rms: {:.6g}\n",
                      fit.reprojection_rms_px, fit.normalised_rms);
  text += fmt::format("    windows: {{total: {}, complete: {}, partial: {}, used: {}}}\n", fit.windows_total,
                      fit.windows_complete, fit.windows_partial, fit.windows_used);
  text += fmt::format("    circles: {{used: {}, rejected: {}}}\n", fit.circles_used, fit.circles_rejected);
  return text;
}

std::string imuYaml(const DocumentedImu& imu) {
  const ImuState& s = imu.state;
  const ImuUncertainty& u = imu.uncertainty;
  std::string text = fmt::format("  {}:\n", yamlText(imu.name));
  text += transformYaml("reference_from_imu", s.reference_from_imu, u.rotation_std_rad, u.translation_std_m);
  text += fmt::format("    time_offset_s: {}\n    time_offset_std_s: {:.6g}\n", s.time_offset_s,
                      u.time_offset_std_s);
  text += fmt::format(
      "    gyroscope:\n      bias_rad_s: {}\n      bias_std_rad_s: {}\n      mapping: {}\n"
      "      mapping_std: {}\n      residual_rms_rad_s: {:.6g}\n",
      list(s.gyroscope_bias_rad_s, kEstimate), list(u.gyroscope_bias_std_rad_s, kSigma),
      rows(s.gyroscope_mapping, kEstimate), rows(u.gyroscope_mapping_std, kSigma),
      imu.fit.gyroscope_rms_rad_s);
  text += fmt::format(
      "    accelerometer:\n      bias_m_s2: {}\n      bias_std_m_s2: {}\n      mapping: {}\n"
      "      mapping_std: {}\n      residual_rms_m_s2: {:.6g}\n",
      list(s.accelerometer_bias_m_s2, kEstimate), list(u.accelerometer_bias_std_m_s2, kSigma),
      rows(s.accelerometer_mapping, kEstimate), rows(u.accelerometer_mapping_std, kSigma),
      imu.fit.accelerometer_rms_m_s2);
  return text;
}

std::string uncertaintyYaml(const UncertaintyReport& report) {
  std::string text = fmt::format("observability:\n  weakest: {}\n  values: [{:.4g}]\n",
                                 yamlText(report.weakest), fmt::join(report.observability, ", "));
  text += "uncertainty:\n  names:\n";
  for (const std::string& name : report.names) text += fmt::format("    - {}\n", yamlText(name));
  text +=
      fmt::format("  standard_deviations: {}\n  correlation:\n", list(report.standard_deviations, kSigma));
  for (Eigen::Index i = 0; i < report.correlation.rows(); ++i)
    text += fmt::format("    - {}\n", list(report.correlation.row(i).transpose(), "{:.4f}"));
  return text;
}

std::string estimatesYaml(const ResultDocument& document) {
  std::string text = fmt::format("reference: {}\ncameras:\n", yamlText(document.reference));
  for (const DocumentedCamera& camera : document.cameras) text += cameraYaml(camera);
  text += "imus:\n";
  for (const DocumentedImu& imu : document.imus) text += imuYaml(imu);
  text += fmt::format("gravity_m_s2: {}\ngravity_direction_std_deg: {:.6g}\n",
                      list(document.gravity_in_world_m_s2, kEstimate),
                      document.uncertainty.gravity_direction_std_rad * kDegPerRad);
  if (!document.uncertainty.names.empty()) text += uncertaintyYaml(document.uncertainty);
  return text;
}

std::string programYaml(const ProgramInfo& program) {
  std::string text = fmt::format("program:\n  version: {}\n", yamlText(program.version));
  if (program.options.empty()) return text + "  options: {}\n";
  text += "  options:\n";
  for (const auto& [name, value] : program.options)
    text += fmt::format("    {}: {}\n", name, yamlText(value));
  return text;
}

}  // namespace

std::string resultYaml(const ResultDocument& document) {
  std::string text = fmt::format("evical_result: 1\nstatus: {}\nreason: {}\n", statusName(document.status),
                                 yamlText(document.reason));
  if (!document.cameras.empty()) text += estimatesYaml(document);
  if (!document.notes.empty()) text += "notes:\n";
  for (const std::string& note : document.notes) text += fmt::format("  - {}\n", yamlText(note));
  const Timing& t = document.timing;
  text += fmt::format(
      "timing_s: {{read: {:.3f}, detect: {:.3f}, initialise: {:.3f}, optimise: {:.3f}, total: {:.3f}}}\n",
      t.read_s, t.detect_s, t.initialise_s, t.optimise_s, t.total_s);
  text += fmt::format("memory_peak_mb: {:.1f}\n", document.memory_peak_mb);
  return text + programYaml(document.program);
}

}  // namespace evical
