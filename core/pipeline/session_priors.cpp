#include "core/pipeline/session_priors.h"

#include "core/base/nearest_name.h"
#include "core/data/unit_quaternion.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kLargest = 1e6;      // of any number here: beyond it is a slip
constexpr double kLargest_m = 100.0;  // of a rig: millimetres written as metres are beyond it

using Numbers = std::vector<double>;

// Nothing if all are 0, as a result writes it of what was given.
std::optional<Numbers> checkedStd(const YamlNode& node, const Numbers& sigmas) {
  if (std::any_of(sigmas.begin(), sigmas.end(), [](double sigma) { return sigma < 0.0 || sigma > kLargest; }))
    throw node.error("standard deviations must be above 0, and not absurd",
                     "Leave it out to hold the value as it is");
  const auto zeros = std::count(sigmas.begin(), sigmas.end(), 0.0);
  if (zeros == static_cast<std::ptrdiff_t>(sigmas.size())) return std::nullopt;
  if (zeros > 0)
    throw node.error("is 0 for some numbers and not for others",
                     "Give each a standard deviation above 0; leave all out to hold the value as it is");
  return sigmas;
}

// One for each number, or one for all.
std::optional<Numbers> readStd(const YamlNode& node, std::size_t count) {
  return checkedStd(node, node.isSequence() ? node.reals(count) : Numbers(count, node.real()));
}

// A sigma beside its value: `key` without `of` says nothing.
std::optional<YamlNode> stdNode(const YamlNode& map, const char* key, const char* of) {
  const auto node = map.find(key);
  if (node && !map.has(of))
    throw node->error(fmt::format("is there without {}", of), fmt::format("Add {}, or remove it", of));
  return node;
}

Eigen::Vector3d vector3(const Numbers& values) {
  return {values[0], values[1], values[2]};
}

Numbers boundedReals(const YamlNode& node, std::size_t count, double largest) {
  Numbers values = node.reals(count);
  for (const double value : values)
    if (std::abs(value) > largest)
      throw node.error(fmt::format("{} is beyond {}", value, largest), "Check the unit");
  return values;
}

std::optional<KnownNumber> readNumber(const YamlNode& map, const char* key, const char* std_key) {
  const auto sigma = stdNode(map, std_key, key), value = map.find(key);
  if (!value) return std::nullopt;
  KnownNumber known{value->real(-kLargest, kLargest, "s")};
  if (const auto sigmas = sigma ? readStd(*sigma, 1) : std::nullopt) known.sigma = sigmas->front();
  return known;
}

std::optional<KnownVector> readVector(const YamlNode& map, const char* key, const char* std_key,
                                      double largest) {
  const auto sigma = stdNode(map, std_key, key), value = map.find(key);
  if (!value) return std::nullopt;
  KnownVector known{vector3(boundedReals(*value, 3, largest))};
  if (const auto sigmas = sigma ? readStd(*sigma, 3) : std::nullopt) known.sigma = vector3(*sigmas);
  return known;
}

std::optional<KnownRotation> readRotation(const YamlNode& map) {
  const auto sigma = stdNode(map, "rotation_std_deg", "rotation_xyzw"), value = map.find("rotation_xyzw");
  if (!value) return std::nullopt;
  const Numbers numbers = value->reals(4);
  KnownRotation known{unitQuaternion(*value, {numbers[0], numbers[1], numbers[2], numbers[3]},
                                     "Give x, y, z, w of the rotation from the sensor to the reference")};
  if (const auto sigmas = sigma ? readStd(*sigma, 3) : std::nullopt)
    known.sigma = vector3(*sigmas) / kDegPerRad;
  return known;
}

Eigen::Matrix3d readMatrix(const YamlNode& node) {
  const std::vector<YamlNode> rows = node.items();
  if (rows.size() != 3) throw node.error("must be three rows of three numbers");
  Eigen::Matrix3d matrix;
  for (int row = 0; row < 3; ++row)
    matrix.row(row) = vector3(boundedReals(rows[static_cast<std::size_t>(row)], 3, kLargest)).transpose();
  return matrix;
}

std::optional<Eigen::Matrix3d> readMatrixStd(const YamlNode& node) {
  Numbers upper;
  if (node.isSequence()) {
    const Eigen::Matrix3d matrix = readMatrix(node);
    for (int row = 0; row < 3; ++row)
      for (int col = row; col < 3; ++col) upper.push_back(matrix(row, col));
  } else {
    upper.assign(6, node.real());
  }
  if (!checkedStd(node, upper)) return std::nullopt;
  Eigen::Matrix3d sigmas = Eigen::Matrix3d::Zero();
  for (int row = 0, k = 0; row < 3; ++row)
    for (int col = row; col < 3; ++col, ++k) sigmas(row, col) = upper[static_cast<std::size_t>(k)];
  return sigmas;
}

std::optional<KnownMapping> readMapping(const YamlNode& map) {
  const auto sigma = stdNode(map, "mapping_std", "mapping"), value = map.find("mapping");
  if (!value) return std::nullopt;
  KnownMapping known{readMatrix(*value)};
  constexpr double kNothing = 1e-9;
  if (Eigen::Matrix3d(known.value.triangularView<Eigen::StrictlyLower>()).cwiseAbs().maxCoeff() > kNothing)
    throw value->error("must be upper triangular",
                       "Give measured = mapping * true + bias, with zeros below the diagonal");
  if (known.value.diagonal().minCoeff() < 0.1 || known.value.diagonal().maxCoeff() > 10.0)
    throw value->error("must have scales near 1 on its diagonal", "Give measured = mapping * true + bias");
  if (sigma) known.sigma = readMatrixStd(*sigma);
  return known;
}

void readPlace(const YamlNode& map, const char* transform_key, SensorPrior& prior) {
  if (const auto transform = map.find(transform_key)) {
    transform->allowOnly({"rotation_xyzw", "rotation_std_deg", "translation_m", "translation_std_m"});
    prior.rotation = readRotation(*transform);
    prior.translation = readVector(*transform, "translation_m", "translation_std_m", kLargest_m);
  }
  prior.time_offset = readNumber(map, "time_offset_s", "time_offset_std_s");
}

// A result says of the reference that it is where it is; anything else is none.
void dropOwnPlace(const YamlNode& map, const char* transform_key, SensorPrior& prior) {
  if ((prior.rotation && !prior.rotation->value.isApprox(Eigen::Quaterniond::Identity(), 1e-9)) ||
      (prior.translation && prior.translation->value.norm() > 0.0))
    throw map[transform_key].error("is that of the reference itself",
                                   "Remove it, or take another reference: transforms are relative to it");
  if (prior.time_offset && prior.time_offset->value != 0.0)
    throw map["time_offset_s"].error("is that of the reference itself, whose clock is the one that counts",
                                     "Remove it, or take another reference");
  prior.rotation.reset();
  prior.translation.reset();
  prior.time_offset.reset();
}

template <class Sensor>
Sensor& sensorOf(const YamlNode& node, const std::string& name, std::vector<Sensor>& sensors) {
  std::vector<std::string> names;
  for (Sensor& sensor : sensors) {
    if (sensor.name == name) return sensor;
    names.push_back(sensor.name);
  }
  throw node.error("the session has no such sensor", nameAdvice(name, names));
}

// Keys of a result that are no priors are passed over.
void readCameraPrior(const YamlNode& map, const std::string& name, Session& session) {
  SessionCamera& camera = sensorOf(map, name, session.cameras);
  map.allowOnly({"reference_from_camera", "time_offset_s", "time_offset_std_s", "stream", "edge_lead_px",
                 "edge_lead_std_px", "edge_lead_growth_px", "edge_lead_growth_std_px", "intrinsics",
                 "intrinsics_std", "reprojection_rms_px", "normalised_rms", "windows", "circles"});
  readPlace(map, "reference_from_camera", camera.prior);
  if (name == session.reference && session.imus.empty())
    dropOwnPlace(map, "reference_from_camera", camera.prior);
}

void readImuPrior(const YamlNode& map, const std::string& name, Session& session) {
  ImuPrior& prior = sensorOf(map, name, session.imus).prior;
  map.allowOnly({"reference_from_imu", "time_offset_s", "time_offset_std_s", "gyroscope", "accelerometer",
                 "stream", "accelerometer_noise_density", "gyroscope_noise_density",
                 "accelerometer_random_walk", "gyroscope_random_walk", "rate_hz"});
  readPlace(map, "reference_from_imu", prior);
  if (name == session.reference) dropOwnPlace(map, "reference_from_imu", prior);
  if (const auto gyroscope = map.find("gyroscope")) {
    gyroscope->allowOnly({"bias_rad_s", "bias_std_rad_s", "mapping", "mapping_std", "residual_rms_rad_s",
                          "gyroscope_from_accelerometer_xyzw", "rotation_std_deg"});
    prior.gyroscope_bias = readVector(*gyroscope, "bias_rad_s", "bias_std_rad_s", kLargest);
    prior.gyroscope_mapping = readMapping(*gyroscope);
  }
  if (const auto accelerometer = map.find("accelerometer")) {
    accelerometer->allowOnly({"bias_m_s2", "bias_std_m_s2", "mapping", "mapping_std", "residual_rms_m_s2"});
    prior.accelerometer_bias = readVector(*accelerometer, "bias_m_s2", "bias_std_m_s2", kLargest);
    prior.accelerometer_mapping = readMapping(*accelerometer);
  }
}

template <class Values>
std::string list(const Values& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
  return "[" + text + "]";
}
std::string matrix(const Eigen::Matrix3d& m) {
  std::string text;
  for (int row = 0; row < 3; ++row) text += (row == 0 ? "" : ", ") + list(Eigen::Vector3d(m.row(row)));
  return "[" + text + "]";
}
// Twelve digits survive the way to radians and back.
std::string degrees(const Eigen::Vector3d& rad) {
  const Eigen::Vector3d deg = kDegPerRad * rad;
  return fmt::format("[{:.12g}, {:.12g}, {:.12g}]", deg.x(), deg.y(), deg.z());
}

std::string placeYaml(const char* transform_key, const SensorPrior& prior) {
  std::string text;
  if (prior.rotation || prior.translation) text += fmt::format("      {}:\n", transform_key);
  if (prior.rotation) {
    text += fmt::format("        rotation_xyzw: {}\n", list(prior.rotation->value.coeffs()));
    if (prior.rotation->sigma)
      text += fmt::format("        rotation_std_deg: {}\n", degrees(*prior.rotation->sigma));
  }
  if (prior.translation) {
    text += fmt::format("        translation_m: {}\n", list(prior.translation->value));
    if (prior.translation->sigma)
      text += fmt::format("        translation_std_m: {}\n", list(*prior.translation->sigma));
  }
  if (prior.time_offset) {
    text += fmt::format("      time_offset_s: {}\n", prior.time_offset->value);
    if (prior.time_offset->sigma)
      text += fmt::format("      time_offset_std_s: {}\n", *prior.time_offset->sigma);
  }
  return text;
}

std::string inertialYaml(const char* key, const char* unit, const std::optional<KnownVector>& bias,
                         const std::optional<KnownMapping>& mapping) {
  if (!bias && !mapping) return {};
  std::string text = fmt::format("      {}:\n", key);
  if (bias) {
    text += fmt::format("        bias_{}: {}\n", unit, list(bias->value));
    if (bias->sigma) text += fmt::format("        bias_std_{}: {}\n", unit, list(*bias->sigma));
  }
  if (mapping) {
    text += fmt::format("        mapping: {}\n", matrix(mapping->value));
    if (mapping->sigma) text += fmt::format("        mapping_std: {}\n", matrix(*mapping->sigma));
  }
  return text;
}

std::string named(const std::string& name, const std::string& content) {
  return content.empty() ? "" : fmt::format("    {}:\n{}", yamlText(name), content);
}

}  // namespace

void readSensorPriors(const YamlNode& prior, Session& session) {
  if (const auto cameras = prior.find("cameras"); cameras && !cameras->isNull())
    for (const std::string& key : cameras->keys()) readCameraPrior((*cameras)[key], key, session);
  if (const auto imus = prior.find("imus"); imus && !imus->isNull())
    for (const std::string& key : imus->keys()) readImuPrior((*imus)[key], key, session);
}

std::string sensorPriorsYaml(const Session& session) {
  std::string cameras, imus;
  for (const SessionCamera& camera : session.cameras)
    cameras += named(camera.name, placeYaml("reference_from_camera", camera.prior));
  for (const SessionImu& imu : session.imus) {
    const ImuPrior& prior = imu.prior;
    imus += named(
        imu.name,
        placeYaml("reference_from_imu", prior) +
            inertialYaml("gyroscope", "rad_s", prior.gyroscope_bias, prior.gyroscope_mapping) +
            inertialYaml("accelerometer", "m_s2", prior.accelerometer_bias, prior.accelerometer_mapping));
  }
  return (cameras.empty() ? "" : "  cameras:\n" + cameras) + (imus.empty() ? "" : "  imus:\n" + imus);
}

}  // namespace evical
