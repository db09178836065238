#include "core/pipeline/session/session_priors.h"

#include "core/base/nearest_name.h"
#include "core/data/unit_quaternion.h"
#include "core/format/quantity_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace evical {
namespace {

constexpr double kLargest = 1e6;  // of any number here: larger values are typing errors

using Numbers = std::vector<double>;

// Absent if all are 0, as results write them for given values.
std::optional<Numbers> checkedStd(const YamlNode& node, const Numbers& sigmas) {
  if (std::any_of(sigmas.begin(), sigmas.end(), [](double sigma) { return sigma < 0.0 || sigma > kLargest; }))
    throw node.error("standard deviations must be positive and plausible", "Remove it to fix the value");
  const auto zeros = std::count(sigmas.begin(), sigmas.end(), 0.0);
  if (zeros == static_cast<std::ptrdiff_t>(sigmas.size())) return std::nullopt;
  if (zeros > 0)
    throw node.error("is 0 for some numbers but not for others",
                     "Give each number a standard deviation above 0, or remove it to fix the value");
  return sigmas;
}

// One sigma for each number, or one for all.
std::optional<Numbers> readStd(const YamlNode& node, std::size_t count) {
  return checkedStd(node, node.isSequence() ? node.reals(count) : Numbers(count, node.real()));
}

// Node of a sigma; `key` without its value `of` is an error.
std::optional<YamlNode> stdNode(const YamlNode& map, const char* key, const char* of) {
  const auto node = map.find(key);
  if (node && !map.has(of))
    throw node->error(fmt::format("is given without {}", of), fmt::format("Add {}, or remove it", of));
  return node;
}

Eigen::Vector3d vector3(const Numbers& values) {
  return {values[0], values[1], values[2]};
}

Numbers boundedReals(const YamlNode& node, std::size_t count, double largest) {
  Numbers values = node.reals(count);
  for (const double value : values)
    if (std::abs(value) > largest)
      throw node.error(fmt::format("{} exceeds {}", value, largest), "Check the unit");
  return values;
}

// Readers of one quantity: the value, then its standard deviations.
void readValue(const YamlNode& node, const QuantityInfo& info, KnownNumber& known) {
  known.value = node.real(-info.largest, info.largest, info.unit);
}
void readSigma(const YamlNode& node, const QuantityInfo&, KnownNumber& known) {
  if (const auto sigmas = readStd(node, 1)) known.sigma = sigmas->front();
}

void readValue(const YamlNode& node, const QuantityInfo& info, KnownVector& known) {
  known.value = vector3(boundedReals(node, 3, info.largest));
}
void readSigma(const YamlNode& node, const QuantityInfo&, KnownVector& known) {
  if (const auto sigmas = readStd(node, 3)) known.sigma = vector3(*sigmas);
}

void readValue(const YamlNode& node, const QuantityInfo&, KnownRotation& known) {
  const Numbers numbers = node.reals(4);
  known.value = unitQuaternion(node, {numbers[0], numbers[1], numbers[2], numbers[3]},
                               "Give x, y, z, w of the rotation");
}
void readSigma(const YamlNode& node, const QuantityInfo& info, KnownRotation& known) {
  if (const auto sigmas = readStd(node, 3)) known.sigma = vector3(*sigmas) / yamlSigmaFactor(info);
}

Eigen::Matrix3d readMatrix(const YamlNode& node) {
  const std::vector<YamlNode> rows = node.items();
  if (rows.size() != 3) throw node.error("must be three rows of three numbers");
  Eigen::Matrix3d matrix;
  for (int row = 0; row < 3; ++row)
    matrix.row(row) = vector3(boundedReals(rows[static_cast<std::size_t>(row)], 3, kLargest)).transpose();
  return matrix;
}

void readValue(const YamlNode& node, const QuantityInfo&, KnownMapping& known) {
  known.value = readMatrix(node);
  constexpr double kNothing = 1e-9;
  if (Eigen::Matrix3d(known.value.triangularView<Eigen::StrictlyLower>()).cwiseAbs().maxCoeff() > kNothing)
    throw node.error("must be upper triangular",
                     "Give measured = mapping * true + bias, with zeros below the diagonal");
  if (known.value.diagonal().minCoeff() < 0.1 || known.value.diagonal().maxCoeff() > 10.0)
    throw node.error("must have scales near 1 on its diagonal", "Give measured = mapping * true + bias");
}
void readSigma(const YamlNode& node, const QuantityInfo&, KnownMapping& known) {
  const Eigen::VectorXd upper =
      node.isSequence() ? quantityNumbers(readMatrix(node)) : Eigen::VectorXd::Constant(6, node.real());
  if (checkedStd(node, Numbers(upper.begin(), upper.end()))) setQuantityNumbers(upper, known.sigma.emplace());
}

template <class Known>
void readPrior(const YamlNode& sensor, const QuantityInfo& info, std::optional<Known>& prior) {
  const auto section = quantitySection(sensor, info);
  if (!section) return;
  const auto value = section->find(info.key), sigma = stdNode(*section, info.std_key, info.key);
  if (!value) return;
  readValue(*value, info, prior.emplace());
  if (sigma) readSigma(*sigma, info, *prior);
  // A result writes zeros for quantities that were not estimated.
  const bool none = quantityNumbers(prior->value).isZero(0.0);
  if (info.presence == QuantityPresence::WhereNotZero && none && sigma && !prior->sigma) prior.reset();
}

// Reads the quantities of a sensor; those without a prior and other keys of a result are ignored.
template <class Rows, class Prior>
void readPriors(const YamlNode& sensor, const Rows& rows, Prior& prior) {
  forEachPriorQuantity(rows, [&](const auto& row) { readPrior(sensor, row.info, row.prior(prior)); });
}

// Removes the reference's pose relative to itself, which results contain as identity; others are errors.
template <class Rows, class Prior>
void dropOwnPlace(const YamlNode& sensor, const Rows& rows, Prior& prior) {
  constexpr double kNothing = 1e-9;
  forEachPriorQuantity(rows, [&](const auto& row) {
    if (!row.info.relative || !row.prior(prior)) return;
    if (quantityNumbers(row.prior(prior)->value).norm() > kNothing) {
      const bool clock = row.info.section == std::string();
      throw sensor.find(clock ? row.info.key : row.info.section)
          .value_or(sensor)
          .error(clock ? "is of the reference itself, whose clock is the time base"
                       : "is of the reference itself",
                 clock ? "Remove it, or choose another reference"
                       : "Remove it, or choose another reference: transforms are relative to it");
    }
    row.prior(prior).reset();
  });
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

// Keys of the quantities in their sections, and further keys of results.
template <class Rows>
void allowOnlyKeys(const YamlNode& sensor, const Rows& rows, std::span<const char* const> besides) {
  std::vector<std::string> keys = quantityKeys(rows);
  keys.insert(keys.end(), besides.begin(), besides.end());
  sensor.allowOnly(keys);
  forEachQuantity(rows, [&](const auto& row) {
    const std::string name = row.info.section;
    const auto section = name.empty() ? std::nullopt : sensor.find(name);
    if (!section) return;
    keys = quantityKeys(rows, name);
    if (name == "gyroscope") keys.push_back("residual_rms_rad_s");
    if (name == "accelerometer") keys.push_back("residual_rms_m_s2");
    section->allowOnly(keys);
  });
}

// Keys of a sensor in results that are not quantities.
constexpr auto keysBesides(CameraSensors) {
  return std::to_array({"stream", "kind", "time_offset_at_s", "reprojection_rms_px", "normalised_rms",
                        "neighbour_agreement", "windows", "circles", "latency_s", "latency_std_s",
                        "latency_against"});
}
constexpr auto keysBesides(ImuSensors) {
  return std::to_array({"stream", "time_offset_at_s", "accelerometer_noise_density",
                        "gyroscope_noise_density", "accelerometer_random_walk", "gyroscope_random_walk",
                        "rate_hz"});
}

// Twelve digits survive the conversion to radians and back.
std::string sigmaYaml(const QuantityInfo&, double sigma) {
  return quantityYaml(sigma, exactYaml);
}
template <class Sigma>
std::string sigmaYaml(const QuantityInfo& info, const Sigma& sigma) {
  const double factor = yamlSigmaFactor(info);
  const NumberFormat twelve_digits = [](double value) { return fmt::format("{:.12g}", value); };
  return quantityYaml(Sigma(factor * sigma), factor == 1.0 ? exactYaml : twelve_digits);
}

template <class Rows, class Prior>
std::string priorsYaml(const Rows& rows, const Prior& prior) {
  YamlSections sections;
  forEachPriorQuantity(rows, [&](const auto& row) {
    const auto& known = row.prior(prior);
    if (!known) return;
    sections.add(row.info.section, row.info.key, quantityYaml(known->value, exactYaml));
    if (known->sigma) sections.add(row.info.section, row.info.std_key, sigmaYaml(row.info, *known->sigma));
  });
  constexpr std::size_t kIndent = 6;
  return sections.text(kIndent);
}

std::string named(const std::string& name, const std::string& content) {
  return content.empty() ? "" : fmt::format("    {}:\n{}", yamlText(name), content);
}

}  // namespace

void readSensorPriors(const YamlNode& prior, Session& session) {
  forEachSensorKind([&](auto kind) {
    const auto sensors = prior.find(kind.kKey);
    if (!sensors || sensors->isNull()) return;
    for (const std::string& name : sensors->keys()) {
      const YamlNode map = (*sensors)[name];
      auto& read = sensorOf(map, name, kind.of(session)).prior;
      allowOnlyKeys(map, kind.rows(), keysBesides(kind));
      readPriors(map, kind.rows(), read);
      if (name == session.reference) dropOwnPlace(map, kind.rows(), read);
    }
  });
}

std::string sensorPriorsYaml(const Session& session) {
  std::string text;
  forEachSensorKind([&](auto kind) {
    std::string sensors;
    for (const auto& sensor : kind.of(session))
      sensors += named(sensor.name, priorsYaml(kind.rows(), sensor.prior));
    if (!sensors.empty()) text += fmt::format("  {}:\n{}", kind.kKey, sensors);
  });
  return text;
}

}  // namespace evical
