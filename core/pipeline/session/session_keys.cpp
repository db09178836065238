#include "core/pipeline/session/session_keys.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/nearest_name.h"
#include "core/recording/column_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace evical {
namespace {

const std::vector<std::string> kImuKeys = {"acceleration_unit", "angular_rate_unit", "gyroscope_axes",
                                           "accelerometer_axes", "clock_scale"};

// The enumerator of this name.
template <class Enum, class Names>
Enum enumFrom(const Names& names, const std::string& key, const std::string& value) {
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end())
    throw badInput(key, fmt::format("'{}' is not a valid value", value),
                   nameAdvice(value, std::vector<std::string>(names.begin(), names.end())));
  return static_cast<Enum>(found - names.begin());
}

// A unit, or a number of units, as for raw counts: "0.000488 g".
template <class Unit, class Names, class Read>
void setUnit(const Names& names, const std::string& key, const std::string& value, Read read,
             std::optional<Unit>& unit, double& factor) {
  const bool number =
      !value.empty() && (value.front() == '.' || (value.front() >= '0' && value.front() <= '9'));
  const auto scaled = number ? read(value) : std::nullopt;
  unit = scaled ? scaled->unit : enumFrom<Unit>(names, key, value);
  factor = scaled ? scaled->factor : 1.0;
}

AxesReading axesOrThrow(const std::string& key, const std::string& value) {
  if (const std::optional<AxesReading> axes = axesFrom(value)) return *axes;
  throw badInput(key, fmt::format("'{}' is not a valid order of axes", value),
                 "Give each of x, y and z once, with '-' for an inverted axis: y,x,-z");
}

double clockScaleFrom(const std::string& key, const std::string& value) {
  return YamlNode::parse(value, key).real(kMinClockScale, 1.0 / kMinClockScale, "");
}

}  // namespace

std::array<double, 2> timeRangeFrom(const YamlNode& node) {
  const std::vector<double> range_s = node.reals(2);
  if (range_s[0] < 0.0 || range_s[1] <= range_s[0])
    throw node.error(fmt::format("[{}, {}] is not a range", range_s[0], range_s[1]),
                     "Give begin and end, in this order, in seconds since the recording's start");
  return {range_s[0], range_s[1]};
}

void setInImu(SessionImu& imu, const std::string& key, const std::string& value) {
  if (key == "acceleration_unit") {
    setUnit(kAccelerationUnits, key, value, accelerationUnitOf, imu.acceleration_unit,
            imu.acceleration_factor);
  } else if (key == "angular_rate_unit") {
    setUnit(kAngularRateUnits, key, value, angularRateUnitOf, imu.angular_rate_unit, imu.angular_rate_factor);
  } else if (key == "gyroscope_axes") {
    imu.gyroscope_axes = axesOrThrow(key, value);
  } else if (key == "accelerometer_axes") {
    imu.accelerometer_axes = axesOrThrow(key, value);
  } else if (key == "clock_scale") {
    imu.clock_scale = clockScaleFrom(key, value);
  } else {
    throw badInput(key, "is not a key of an IMU that can be set", nameAdvice(key, kImuKeys));
  }
}

void setInSession(Session& session, const std::string& key, const std::string& value) {
  if (key == "time_range_s") {
    session.time_range_s = timeRangeFrom(YamlNode::parse(value, key));
    return;
  }
  for (SessionCamera& camera : session.cameras) {
    if (key == "cameras." + camera.name + ".mirrored") {
      camera.mirrored = enumFrom<Mirroring>(kMirroringNames, key, value);
      return;
    }
    if (key != "cameras." + camera.name + ".clock_scale") continue;
    camera.clock_scale = clockScaleFrom(key, value);
    return;
  }
  const std::string imus = "imus.";
  const std::size_t dot = key.rfind('.');
  if (!key.starts_with(imus) || dot < imus.size()) return setOption(session.options, key, value);
  const std::string name = key.substr(imus.size(), dot - imus.size());
  std::vector<std::string> names;
  for (SessionImu& imu : session.imus) {
    if (imu.name == name) return setInImu(imu, key.substr(dot + 1), value);
    names.push_back(imu.name);
  }
  throw badInput(key, "the session has no such IMU", nameAdvice(name, names));
}

Repair ofRawAxes(const Repair& repair, const Session& session) {
  const std::optional<AxesReading> then = axesFrom(repair.value);
  if (!then) return repair;
  for (const SessionImu& imu : session.imus)
    for (const auto& [key, first] : {std::pair{".gyroscope_axes", imu.gyroscope_axes},
                                     std::pair{".accelerometer_axes", imu.accelerometer_axes}})
      if (repair.key == "imus." + imu.name + key) return {repair.key, axesText(readAfter(first, *then))};
  return repair;
}

std::string nameFrom(const YamlNode& node) {
  std::string text = node.text();
  if (text.empty()) throw node.error("is empty", "Give a name");
  return text;
}

std::filesystem::path pathFrom(const YamlNode& node) {
  std::string text = node.anyText();
  if (text.empty()) throw node.error("is empty", "Name a file");
  return text;
}

std::filesystem::path besideSession(const YamlNode& node, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / pathFrom(node);
  if (!pathExists(path))
    throw node.error(fmt::format("'{}' does not exist", path.string()),
                     "Paths are relative to the session file");
  return path;
}

void setFromSession(const YamlNode& node, CalibrationOptions& options, const std::string& option) {
  try {
    setOption(options, option, node.text());
  } catch (const CalibrationError& problem) {
    throw node.error(problem.problem(), problem.advice());
  }
}

}  // namespace evical
