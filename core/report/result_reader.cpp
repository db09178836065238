#include "core/base/yaml_node.h"
#include "core/data/calibration_observer.h"
#include "core/data/unit_quaternion.h"
#include "core/format/intrinsics_yaml.h"
#include "core/format/quantity_yaml.h"
#include "core/numerics/angles.h"
#include "core/report/result_yaml.h"
#include "core/report/shown_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace evical {
namespace {

// Unlike YamlNode::real this accepts values that are not finite: an unknown sigma is written as .nan.
double number(const YamlNode& node) {
  const std::string text = node.text();
  if (text == ".nan") return std::numeric_limits<double>::quiet_NaN();
  if (text == ".inf") return std::numeric_limits<double>::infinity();
  if (text == "-.inf") return -std::numeric_limits<double>::infinity();
  return node.real();
}

template <int Size>
Eigen::Matrix<double, Size, 1> vector(const YamlNode& node) {
  const std::vector<YamlNode> items = node.items();
  if (items.size() != Size)
    throw node.error(fmt::format("has {} numbers, {} are needed", items.size(), Size));
  Eigen::Matrix<double, Size, 1> values;
  for (int i = 0; i < Size; ++i) values[i] = number(items[static_cast<std::size_t>(i)]);
  return values;
}

void get(const YamlNode& map, const char* key, double& value) {
  if (const auto node = map.find(key)) value = number(*node);
}
void get(const YamlNode& map, const char* key, int& value) {
  if (const auto node = map.find(key)) value = node->integer(0, std::numeric_limits<int>::max());
}
void get(const YamlNode& map, const char* key, std::string& value) {
  if (const auto node = map.find(key)) value = node->text();
}
void get(const YamlNode& map, const char* key, Eigen::Vector3d& value) {
  if (const auto node = map.find(key)) value = vector<3>(*node);
}
void get(const YamlNode& map, const char* key, Eigen::Matrix3d& value) {
  const auto node = map.find(key);
  if (!node) return;
  const std::vector<YamlNode> rows = node->items();
  if (rows.size() != 3) throw node->error("must be three rows of three numbers");
  for (int row = 0; row < 3; ++row)
    value.row(row) = vector<3>(rows[static_cast<std::size_t>(row)]).transpose();
}
void get(const YamlNode& map, const char* key, std::vector<std::string>& values) {
  const auto node = map.find(key);
  if (!node) return;
  for (const YamlNode& item : node->items()) values.push_back(item.anyText());
}

void get(const YamlNode& map, const char* key, Eigen::Quaterniond& value) {
  if (const auto node = map.find(key)) value = unitQuaternion(*node, vector<4>(*node));
}

void getSigma(const YamlNode& map, const QuantityInfo& info, double& sigma) {
  get(map, info.std_key, sigma);
}
template <class Sigma>
void getSigma(const YamlNode& map, const QuantityInfo& info, Sigma& sigma) {
  get(map, info.std_key, sigma);
  sigma /= yamlSigmaFactor(info);
}

// Reads all quantities except intrinsics, which have a separate map. The pose is mandatory.
template <class Rows, class State, class Uncertainty>
void readQuantities(const YamlNode& sensor, const Rows& rows, State& state, Uncertainty& uncertainty) {
  forEachQuantity(rows, [&](const auto& row) {
    if constexpr (!std::is_same_v<decltype(row.value(state)), std::optional<CameraIntrinsics>&>) {
      const bool pose = row.info.id == QuantityId::Rotation || row.info.id == QuantityId::Translation;
      if (pose && row.info.owner != QuantityOwner::Board)
        static_cast<void>(sensor[row.info.section][row.info.key]);  // throws if it is missing
      const auto section = quantitySection(sensor, row.info);
      if (!section) return;
      get(*section, row.info.key, row.value(state));
      getSigma(*section, row.info, row.sigma(uncertainty));
    }
  });
}

std::string streamOf(const YamlNode& map) {
  std::string stream;
  get(map, "stream", stream);
  return stream;
}

std::optional<std::array<double, 9>> readIntrinsicsStd(const YamlNode& camera) {
  const auto map = camera.find("intrinsics_std");
  if (!map) return std::nullopt;
  const std::vector<double> focal = (*map)["focal_length_px"].reals(2);
  const std::vector<double> principal = (*map)["principal_point_px"].reals(2);
  const YamlNode node = (*map)["distortion"];
  const std::vector<double> distortion = node.reals();
  if (distortion.size() > 5) throw node.error("has more than 5 numbers");
  std::array<double, 9> sigmas = {focal[0], focal[1], principal[0], principal[1]};
  std::copy(distortion.begin(), distortion.end(), sigmas.begin() + 4);
  return sigmas;
}

SensorDescription readCamera(const YamlNode& map, const std::string& name, CalibrationResult& result) {
  CameraState state;
  CameraUncertainty sigma;
  CameraFit fit;
  readQuantities(map, kCameraQuantities, state, sigma);
  get(map, "time_offset_at_s", state.time_offset_at_s);
  get(map, "reprojection_rms_px", fit.reprojection_rms_px);
  get(map, "normalised_rms", fit.normalised_rms);
  get(map, "neighbour_agreement", fit.neighbour_agreement);
  if (const auto windows = map.find("windows")) {
    get(*windows, "total", fit.windows_total);
    get(*windows, "complete", fit.windows_complete);
    get(*windows, "partial", fit.windows_partial);
    get(*windows, "used", fit.windows_used);
    get(*windows, "rejected_by_hand", fit.windows_rejected);
  }
  if (const auto circles = map.find("circles")) {
    get(*circles, "used", fit.circles_used);
    get(*circles, "rejected", fit.circles_rejected);
  }
  if (const auto intrinsics = map.find("intrinsics")) state.lens = givenLens(readIntrinsics(*intrinsics));
  sigma.intrinsics_std = readIntrinsicsStd(map);
  result.state.cameras.push_back(state);
  result.uncertainty.cameras.push_back(sigma);
  result.cameras.push_back(fit);
  SensorDescription known{name, streamOf(map)};
  if (const auto kind = map.find("kind"))
    known.kind = static_cast<CameraKind>(kind->choice({"events", "frames", "points"}));
  return known;
}

std::size_t cameraOf(const YamlNode& name, const NamedResult& named) {
  const auto found = std::find_if(named.cameras.begin(), named.cameras.end(),
                                  [&](const auto& each) { return each.name == name.text(); });
  if (found == named.cameras.end()) throw name.error("is not one of the cameras");
  return static_cast<std::size_t>(found - named.cameras.begin());
}

void readLatencies(const YamlNode& cameras, const NamedResult& named, CalibrationResult& result) {
  for (std::size_t i = 0; i < named.cameras.size(); ++i) {
    const YamlNode camera = cameras[named.cameras[i].name];
    const auto against = camera.find("latency_against");
    if (!against) continue;
    SensorLatency latency{i};
    latency.against = cameraOf(*against, named);
    get(camera, "latency_s", latency.latency_s);
    get(camera, "latency_std_s", latency.std_s);
    result.latencies.push_back(latency);
  }
}

SensorDescription readKnown(const YamlNode& map, const std::string& name) {
  SensorDescription known{name, streamOf(map)};
  get(map, "accelerometer_stream", known.accelerometer_stream);
  if (map.has("accelerometer_noise_density") && map.has("gyroscope_noise_density")) {
    known.noise.accelerometer_density = map["accelerometer_noise_density"].real();
    known.noise.gyroscope_density = map["gyroscope_noise_density"].real();
  }
  get(map, "accelerometer_random_walk", known.noise.accelerometer_random_walk);
  get(map, "gyroscope_random_walk", known.noise.gyroscope_random_walk);
  get(map, "rate_hz", known.rate_hz);
  return known;
}

SensorDescription readImu(const YamlNode& map, const std::string& name, CalibrationResult& result) {
  ImuState state;
  ImuUncertainty sigma;
  ImuFit fit;
  readQuantities(map, kImuQuantities, state, sigma);
  get(map, "time_offset_at_s", state.time_offset_at_s);
  if (const auto gyroscope = map.find("gyroscope"))
    get(*gyroscope, "residual_rms_rad_s", fit.gyroscope_rms_rad_s);
  if (const auto accelerometer = map.find("accelerometer"))
    get(*accelerometer, "residual_rms_m_s2", fit.accelerometer_rms_m_s2);
  result.state.imus.push_back(state);
  result.uncertainty.imus.push_back(sigma);
  result.imus.push_back(fit);
  return readKnown(map, name);
}

// Columns of the covariance: sensor and quantity of each number.
std::vector<QuantityAddress> readColumns(const YamlNode& list, const NamedResult& named,
                                         const CalibrationState& state) {
  std::map<std::string, QuantityAddress> known;
  for (const QuantityAddress& number : quantityAddresses(state)) known[columnKeys(number, named)] = number;
  std::vector<QuantityAddress> columns;
  for (const YamlNode& item : list.items()) {
    std::string keys;
    const auto append = [&](const char* key, const std::string& text) {
      keys += fmt::format("{}{}: {}", keys.empty() ? "" : ", ", key, text);
    };
    for (const char* const key : {"camera", "imu", "board"})
      if (const auto node = item.find(key)) append(key, yamlText(node->text()));
    for (const char* const key : {"quantity", "component"})
      if (const auto node = item.find(key)) append(key, node->text());
    if (!known.contains(keys))
      throw item.error(fmt::format("{} is not among the numbers of this result", keys));
    columns.push_back(known[keys]);
  }
  return columns;
}

void readUncertainty(const YamlNode& root, const NamedResult& named, const CalibrationState& state,
                     UncertaintyReport& uncertainty) {
  double gravity_std_deg = 0.0;
  get(root, "gravity_direction_std_deg", gravity_std_deg);
  uncertainty.gravity_direction_std_rad = kRadPerDeg * gravity_std_deg;
  get(root, "gravity_norm_std_m_s2", uncertainty.gravity_norm_std_m_s2);
  get(root, "given", uncertainty.given);
  if (const auto map = root.find("observability")) {
    get(*map, "weakest", uncertainty.weakest);
    get(*map, "directions", uncertainty.directions);
    if (const auto values = map->find("values"))
      for (const YamlNode& value : values->items()) uncertainty.observability.push_back(number(value));
  }
  const auto map = root.find("uncertainty");
  if (!map) return;
  uncertainty.columns = readColumns((*map)["columns"], named, state);
  const auto count = static_cast<Eigen::Index>(uncertainty.columns.size());
  const std::vector<YamlNode> sigmas = (*map)["std"].items(), rows = (*map)["correlation"].items();
  if (sigmas.size() != uncertainty.columns.size() || rows.size() != sigmas.size())
    throw map->error("columns, std and correlation must have the same size");
  uncertainty.standard_deviations.resize(count);
  uncertainty.correlation.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::vector<YamlNode> row = rows[static_cast<std::size_t>(i)].items();
    if (row.size() != sigmas.size()) throw map->error("correlation must be square");
    uncertainty.standard_deviations[i] = number(sigmas[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < count; ++j)
      uncertainty.correlation(i, j) = number(row[static_cast<std::size_t>(j)]);
  }
}

void readSplitHalfCheck(const YamlNode& map, SplitHalfCheck& validation) {
  get(map, "block_s", validation.block_s);
  get(map, "failure", validation.failure);
  get(map, "rms_sigmas", validation.rms_sigmas);
  if (const auto windows = map.find("windows")) {
    const std::vector<YamlNode> halves = windows->items();
    if (halves.size() != 2) throw windows->error("must be two numbers");
    for (std::size_t i = 0; i < 2; ++i)
      validation.windows[i] = halves[i].integer(0, std::numeric_limits<int>::max());
  }
  const auto differences = map.find("differences");
  if (!differences) return;
  for (const YamlNode& item : differences->items()) {
    QuantityDifference& each = validation.quantities.emplace_back();
    each.name = item["name"].text();
    get(item, "unit", each.unit);
    get(item, "difference", each.difference);
    get(item, "std", each.sigma);
  }
}

// One board, or several by name: the world's first.
void readBoards(const YamlNode& root, NamedResult& named, CalibrationResult& result) {
  if (const auto board = root.find("board"))
    readQuantities(*board, kBoardQuantities, result.state.board, result.uncertainty.board);
  const auto several = root.find("boards");
  if (!several) return;
  named.boards = several->keys();
  if (named.boards.empty()) throw several->error("is empty");
  result.state.further_boards.resize(named.boards.size() - 1);
  result.uncertainty.further_boards.resize(named.boards.size() - 1);
  for (std::size_t i = 0; i < named.boards.size(); ++i)
    if (const YamlNode map = (*several)[named.boards[i]]; map.isMap())
      readQuantities(map, kBoardQuantities, result.state.boardAt(i), result.uncertainty.boardAt(i));
}

void readRun(const YamlNode& root, NamedResult& named, CalibrationResult& result) {
  get(root, "notes", result.notes);
  get(root, "memory_peak_mb", result.memory_peak_mb);
  if (const auto timing = root.find("timing_s")) {
    forEachTiming(result.timing, [&](const char* key, double& duration_s) { get(*timing, key, duration_s); });
  }
  const auto program = root.find("program");
  if (!program) return;
  get(*program, "version", named.version);
  if (const auto options = program->find("options"))
    for (const std::string& key : options->keys()) {
      OptionRow row;
      row.name = key;
      row.value = (*options)[key].text();
      named.options.push_back(row);
    }
}

void readWarnings(const YamlNode& root, const char* key, std::vector<QualityWarning>& causes) {
  const auto list = root.find(key);
  if (!list) return;
  for (const YamlNode& item : list->items()) {
    QualityWarning& cause = causes.emplace_back();
    get(item, "name", cause.name);
    get(item, "explains", cause.explains);
    get(item, "text", cause.text);
    if (const auto set = item.find("set"))
      for (const std::string& option : set->keys()) cause.repair = Repair{option, (*set)[option].text()};
  }
}

void checkVersion(const YamlNode& version) {
  constexpr int kVersion = 1;
  if (version.text() != std::to_string(kVersion))
    throw version.error(
        fmt::format("is {}; this program reads files of version {}", version.text(), kVersion),
        "Calibrate again, or use the program that wrote it");
}

NamedResult resultFrom(const YamlNode& root) {
  if (!root.isMap() || !(root.has("evical_result") || root.has("evical_truth")))
    throw root.error("is neither a result nor a truth file",
                     "Give result.yaml of a calibration, or truth.yaml");
  checkVersion(root[root.has("evical_result") ? "evical_result" : "evical_truth"]);
  NamedResult named;
  CalibrationResult result;
  if (const auto status = root.find("status"))
    result.status = static_cast<CalibrationStatus>(status->choice({"ok", "doubtful", "failed"}));
  get(root, "reason", result.reason);
  if (const auto repair = root.find("repair"))
    result.repair = Repair{(*repair)["set"].text(), (*repair)["to"].text()};
  readWarnings(root, "causes", result.causes);
  readWarnings(root, "freed", result.freed);
  get(root, "reference", named.reference);
  if (const auto recording = root.find("recording")) result.start_ns = (*recording)["start_ns"].nanoseconds();
  if (const auto cameras = root.find("cameras"))
    for (const std::string& key : cameras->keys())
      named.cameras.push_back(readCamera((*cameras)[key], key, result));
  if (const auto imus = root.find("imus"))
    for (const std::string& key : imus->keys()) named.imus.push_back(readImu((*imus)[key], key, result));
  readBoards(root, named, result);
  if (const auto cameras = root.find("cameras")) readLatencies(*cameras, named, result);
  if (const auto rejected = root.find("rejected_windows"))
    for (const YamlNode& window : rejected->items())
      result.rejected_windows.push_back({cameraOf(window["camera"], named), window["time_s"].real()});
  get(root, "gravity_m_s2", result.state.gravity_in_world_m_s2);
  readUncertainty(root, named, result.state, result.uncertainty);
  if (const auto validation = root.find("split_half_check"))
    readSplitHalfCheck(*validation, result.split_half_check.emplace());
  readRun(root, named, result);
  named.result = std::make_shared<const CalibrationResult>(std::move(result));
  return named;
}

}  // namespace

NamedResult readResultYaml(const std::filesystem::path& file) {
  return resultFrom(YamlNode::load(file));
}

NamedResult parseResultYaml(const std::string& text, const std::string& place) {
  return resultFrom(YamlNode::parse(text, place));
}

}  // namespace evical
