#include "core/report/result_yaml.h"

#include "core/base/element.h"
#include "core/base/yaml_node.h"
#include "core/data/calibration_observer.h"
#include "core/format/intrinsics_yaml.h"
#include "core/format/quantity_yaml.h"
#include "core/numerics/angles.h"
#include "core/report/intrinsics_report.h"
#include "core/report/shown_quantity.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {
namespace {

constexpr std::size_t kSensorIndent = 4;

template <class Values>
std::string list(const Values& values, NumberFormat format) {
  return quantityYaml(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
                          values.data(), static_cast<Eigen::Index>(values.size()))),
                      format);
}

void addSigma(const QuantityInfo& info, double sigma, YamlSections& sections) {
  sections.add(info.section, info.std_key, quantityYaml(sigma, roundedYaml));
}
template <class Sigma>
void addSigma(const QuantityInfo& info, const Sigma& sigma, YamlSections& sections) {
  sections.add(info.section, info.std_key, quantityYaml(Sigma(yamlSigmaFactor(info) * sigma), roundedYaml));
}

// If clocks drift, the time offset refers to a given time.
template <class State>
void addTimeOfOffset(const State& state, YamlSections& sections) {
  if (state.time_offset_drift_ppm != 0.0)
    sections.add({}, "time_offset_at_s", quantityYaml(state.time_offset_at_s, exactYaml));
}

enum class Written { Values, Sigmas, Both };

// Rows that `chosen` selects, except intrinsics, which have a separate map.
template <class Rows, class State, class Uncertainty, class Chosen>
void addQuantities(const Rows& rows, const State& state, const Uncertainty& uncertainty, Written written,
                   YamlSections& sections, Chosen&& chosen) {
  forEachQuantity(rows, [&](const auto& row) {
    const QuantityInfo& info = row.info;
    if (!chosen(info)) return;
    if (info.written == QuantityWriting::WherePresent && !isPresent(row, state, uncertainty)) return;
    if constexpr (!std::is_same_v<decltype(row.value(state)), const std::optional<CameraIntrinsics>&>) {
      if (written != Written::Sigmas)
        sections.add(info.section, info.key, quantityYaml(row.value(state), exactYaml));
      if (written != Written::Values) addSigma(info, row.sigma(uncertainty), sections);
    }
  });
}

bool inPose(const QuantityInfo& info) {
  return info.id == QuantityId::Rotation || info.id == QuantityId::Translation;
}
bool besidesPose(const QuantityInfo& info) {
  return !inPose(info);
}

// The pose comes first, its numbers before its sigmas.
template <class Rows, class State, class Uncertainty>
void addPlace(const Rows& rows, const State& state, const Uncertainty& uncertainty, YamlSections& sections) {
  addQuantities(rows, state, uncertainty, Written::Values, sections, inPose);
  addQuantities(rows, state, uncertainty, Written::Sigmas, sections, inPose);
}

std::string streamYaml(const std::string& stream, const char* key = "stream") {
  return stream.empty() ? "" : fmt::format("    {}: {}\n", key, yamlText(stream));
}

std::string kindYaml(CameraKind kind) {
  if (kind == CameraKind::Events) return "";
  return fmt::format("    kind: {}\n", kind == CameraKind::Frames ? "frames" : "points");
}

std::string latencyYaml(const NamedResult& named, std::size_t camera) {
  std::string text;
  for (const SensorLatency& latency : named.result->latencies)
    if (latency.camera == camera)
      text += fmt::format("    latency_s: {}\n    latency_std_s: {}\n    latency_against: {}\n",
                          exactYaml(latency.latency_s), roundedYaml(latency.std_s),
                          yamlText(named.cameras.at(latency.against).name));
  return text;
}

std::string cameraYaml(const NamedResult& named, std::size_t i) {
  const CameraState& state = named.result->state.cameras[i];
  const CameraUncertainty sigma = elementOrNone(named.result->uncertainty.cameras, i);
  const CameraFit fit = elementOrNone(named.result->cameras, i);
  std::string text = fmt::format("  {}:\n", yamlText(named.cameras.at(i).name));
  text += streamYaml(named.cameras[i].stream) + kindYaml(named.cameras[i].kind);
  YamlSections sections;
  addPlace(kCameraQuantities, state, sigma, sections);
  addQuantities(kCameraQuantities, state, sigma, Written::Both, sections, besidesPose);
  addTimeOfOffset(state, sections);
  text += sections.text(kSensorIndent) + latencyYaml(named, i);
  if (const std::optional<CameraIntrinsics>& intrinsics = state.lens.inUse()) {
    text += "    intrinsics:\n" + intrinsicsYaml(*intrinsics, 6);
    if (sigma.intrinsics_std)
      text += "    intrinsics_std:\n" + intrinsicsStdYaml(*intrinsics, *sigma.intrinsics_std, 6);
  }
  text += fmt::format("    reprojection_rms_px: {}\n    normalised_rms: {}\n",
                      roundedYaml(fit.reprojection_rms_px), roundedYaml(fit.normalised_rms));
  if (fit.neighbour_agreement > 0.0)
    text += fmt::format("    neighbour_agreement: {}\n", roundedYaml(fit.neighbour_agreement));
  text += fmt::format(
      "    windows: {{total: {}, complete: {}, partial: {}, used: {}{}}}\n    circles: {{used: {}, rejected: "
      "{}}}\n",
      fit.windows_total, fit.windows_complete, fit.windows_partial, fit.windows_used,
      fit.windows_rejected > 0 ? fmt::format(", rejected_by_hand: {}", fit.windows_rejected) : "",
      fit.circles_used, fit.circles_rejected);
  return text;
}

std::string knownYaml(const SensorDescription& known) {
  std::string text =
      streamYaml(known.stream) + streamYaml(known.accelerometer_stream, "accelerometer_stream");
  const auto add = [&](const char* key, double value) {
    if (value > 0.0) text += fmt::format("    {}: {}\n", key, exactYaml(value));
  };
  add("accelerometer_noise_density", known.noise.accelerometer_density);
  add("gyroscope_noise_density", known.noise.gyroscope_density);
  add("accelerometer_random_walk", known.noise.accelerometer_random_walk);
  add("gyroscope_random_walk", known.noise.gyroscope_random_walk);
  add("rate_hz", known.rate_hz);
  return text;
}

std::string imuYaml(const NamedResult& named, std::size_t i) {
  const ImuState& state = named.result->state.imus[i];
  const ImuUncertainty sigma = elementOrNone(named.result->uncertainty.imus, i);
  const ImuFit fit = elementOrNone(named.result->imus, i);
  std::string text = fmt::format("  {}:\n", yamlText(named.imus.at(i).name));
  text += knownYaml(named.imus[i]);
  YamlSections sections;
  addPlace(kImuQuantities, state, sigma, sections);
  addQuantities(kImuQuantities, state, sigma, Written::Both, sections, [](const QuantityInfo& info) {
    return besidesPose(info) && info.presence == QuantityPresence::Always;
  });
  sections.add("gyroscope", "residual_rms_rad_s", roundedYaml(fit.gyroscope_rms_rad_s));
  sections.add("accelerometer", "residual_rms_m_s2", roundedYaml(fit.accelerometer_rms_m_s2));
  addQuantities(kImuQuantities, state, sigma, Written::Both, sections, [](const QuantityInfo& info) {
    return besidesPose(info) && info.presence != QuantityPresence::Always;
  });
  addTimeOfOffset(state, sections);
  return text + sections.text(kSensorIndent);
}

std::string boardYaml(const BoardState& state, const BoardUncertainty& sigma, std::size_t indent) {
  YamlSections sections;
  addQuantities(kBoardQuantities, state, sigma, Written::Both, sections,
                [](const QuantityInfo&) { return true; });
  return sections.text(indent);
}

// One board, or several by name: the world's first.
std::string boardsYaml(const NamedResult& named) {
  const CalibrationResult& result = *named.result;
  if (named.boards.size() < 2) {
    const std::string text = boardYaml(result.state.board, result.uncertainty.board, 2);
    return text.empty() ? "" : "board:\n" + text;
  }
  std::string text = "boards:\n";
  for (std::size_t i = 0; i < named.boards.size() && i <= result.state.further_boards.size(); ++i) {
    const std::string board = boardYaml(result.state.boardAt(i), boardUncertainty(result.uncertainty, i), 4);
    text += fmt::format("  {}:{}\n", yamlText(named.boards[i]), board.empty() ? " {}" : "") + board;
  }
  return text;
}

std::string uncertaintyYaml(const NamedResult& named) {
  const UncertaintyReport& uncertainty = named.result->uncertainty;
  std::string text =
      fmt::format("gravity_direction_std_deg: {}\nobservability:\n  weakest: {}\n  values: {}\n",
                  roundedYaml(kDegPerRad * uncertainty.gravity_direction_std_rad),
                  yamlText(uncertainty.weakest), list(uncertainty.observability, roundedYaml));
  if (!uncertainty.directions.empty()) text += "  directions:\n";
  for (const std::string& words : uncertainty.directions) text += fmt::format("    - {}\n", yamlLine(words));
  if (uncertainty.gravity_norm_std_m_s2 > 0.0)
    text += fmt::format("gravity_norm_std_m_s2: {}\n", roundedYaml(uncertainty.gravity_norm_std_m_s2));
  if (!uncertainty.given.empty()) {
    text += "given:\n";
    for (const std::string& quantity : uncertainty.given) text += fmt::format("  - {}\n", yamlText(quantity));
  }
  if (uncertainty.columns.empty()) return text;
  text += "uncertainty:\n  columns:\n";
  for (const QuantityAddress& column : uncertainty.columns)
    text += fmt::format("    - {{{}, unit: {}}}\n", columnKeys(column, named),
                        yamlText(quantityPart(column).unit));
  text += fmt::format("  std: {}\n  correlation:\n", list(uncertainty.standard_deviations, roundedYaml));
  const NumberFormat fourDecimals = [](double value) { return roundedYaml(std::round(value * 1e4) / 1e4); };
  for (Eigen::Index row = 0; row < uncertainty.correlation.rows(); ++row)
    text += fmt::format("    - {}\n", list(Eigen::VectorXd(uncertainty.correlation.row(row)), fourDecimals));
  return text;
}

std::string splitHalfCheckYaml(const SplitHalfCheck& validation) {
  std::string text =
      fmt::format("split_half_check:\n  block_s: {}\n  windows: [{}, {}]\n", roundedYaml(validation.block_s),
                  validation.windows[0], validation.windows[1]);
  if (!validation.failure.empty()) return text + fmt::format("  failure: {}\n", yamlLine(validation.failure));
  text += fmt::format("  rms_sigmas: {}\n  differences:\n", roundedYaml(validation.rms_sigmas));
  for (const QuantityDifference& each : validation.quantities)
    text += fmt::format("    - {{name: {}, unit: {}, difference: {}, std: {}}}\n", yamlText(each.name),
                        yamlText(each.unit), roundedYaml(each.difference), roundedYaml(each.sigma));
  return text;
}

// Windows that were rejected by hand.
std::string rejectedYaml(const NamedResult& named) {
  std::string text;
  for (const RejectedWindow& window : named.result->rejected_windows)
    text += fmt::format("  - {{camera: {}, time_s: {}}}\n", yamlText(named.cameras.at(window.camera).name),
                        exactYaml(window.time_s));
  return text.empty() ? text : "rejected_windows:\n" + text;
}

// Warnings one by one, below a key.
std::string warningsYaml(const char* key, const std::vector<QualityWarning>& causes) {
  std::string text;
  for (const QualityWarning& cause : causes) {
    text += fmt::format("  - name: {}\n", yamlText(cause.name));
    if (cause.explains > 0.0) text += fmt::format("    explains: {}\n", roundedYaml(cause.explains));
    text += fmt::format("    text: {}\n", yamlLine(cause.text));
    if (cause.repair)
      text +=
          fmt::format("    set: {{{}: {}}}\n", yamlText(cause.repair->key), yamlText(cause.repair->value));
  }
  return text.empty() ? text : fmt::format("{}:\n{}", key, text);
}

std::string runYaml(const NamedResult& named) {
  std::string text = rejectedYaml(named);
  text += named.result->notes.empty() ? "notes: []\n" : "notes:\n";
  for (const std::string& note : named.result->notes) text += fmt::format("  - {}\n", yamlLine(note));
  std::string timing;
  forEachTiming(named.result->timing, [&](const char* key, double duration_s) {
    timing += fmt::format("{}{}: {:.3f}", timing.empty() ? "" : ", ", key, duration_s);
  });
  text += fmt::format("timing_s: {{{}}}\n", timing);
  text += fmt::format("memory_peak_mb: {:.0f}\nprogram:\n  version: {}\n", named.result->memory_peak_mb,
                      yamlLine(named.version));
  text += named.options.empty() ? "  options: {}\n" : "  options:\n";
  for (const OptionRow& row : named.options) text += fmt::format("    {}: {}\n", row.name, row.value);
  return text;
}

}  // namespace

std::vector<std::string> sensorNames(const std::vector<SensorDescription>& sensors) {
  std::vector<std::string> names;
  for (const SensorDescription& sensor : sensors) names.push_back(sensor.name);
  return names;
}

std::vector<CameraKind> cameraKinds(const NamedResult& named) {
  std::vector<CameraKind> kinds;
  for (const SensorDescription& camera : named.cameras) kinds.push_back(camera.kind);
  return kinds;
}

const char* statusName(CalibrationStatus status) {
  if (status == CalibrationStatus::Ok) return "ok";
  return status == CalibrationStatus::Doubtful ? "doubtful" : "failed";
}

std::string resultYaml(const NamedResult& named) {
  const CalibrationState& state = named.result->state;
  std::string text = fmt::format("evical_result: 1\nstatus: {}\nreason: {}\nreference: {}\n",
                                 statusName(named.result->status), yamlLine(named.result->reason),
                                 yamlText(named.reference));
  if (const std::optional<Repair>& repair = named.result->repair)
    text += fmt::format("repair: {{set: {}, to: {}}}\n", yamlText(repair->key), yamlText(repair->value));
  text += warningsYaml("causes", named.result->causes) + warningsYaml("freed", named.result->freed);
  if (named.result->start_ns) text += fmt::format("recording:\n  start_ns: {}\n", *named.result->start_ns);
  text += state.cameras.empty() ? "cameras: {}\n" : "cameras:\n";
  for (std::size_t i = 0; i < state.cameras.size(); ++i) text += cameraYaml(named, i);
  text += state.imus.empty() ? "imus: {}\n" : "imus:\n";
  for (std::size_t i = 0; i < state.imus.size(); ++i) text += imuYaml(named, i);
  text += boardsYaml(named);
  if (!state.imus.empty())
    text += fmt::format("gravity_m_s2: {}\n", list(state.gravity_in_world_m_s2, exactYaml));
  text += uncertaintyYaml(named);
  if (named.result->split_half_check) text += splitHalfCheckYaml(*named.result->split_half_check);
  return text + runYaml(named);
}

}  // namespace evical
