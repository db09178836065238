#include "core/data/imu_units.h"

#include "core/data/likely_unit.h"

#include <cmath>
#include <cstdlib>
#include <span>

namespace evical {
namespace {

bool isNothing(const Eigen::Vector3d& values) {
  return values.isZero(0.0) || !values.allFinite();
}

struct NamedUnit {
  const char* name;
  double si;
  bool in_sessions;
};
constexpr std::array<NamedUnit, 7> kRateUnits = {{{"rad/s", 1.0, true},
                                                  {"deg/s", kRadPerDeg, true},
                                                  {"mrad/s", 1e-3, false},
                                                  {"mdeg/s", 1e-3 * kRadPerDeg, false},
                                                  {"deg/min", kRadPerDeg / 60.0, false},
                                                  {"deg/ms", 1e3 * kRadPerDeg, false},
                                                  {"turns/min", 6.0 * kRadPerDeg, false}}};
constexpr std::array<NamedUnit, 6> kForceUnits = {{{"m/s^2", 1.0, true},
                                                   {"g", kStandardGravity_m_s2, true},
                                                   {"mg", 1e-3 * kStandardGravity_m_s2, false},
                                                   {"mm/s^2", 1e-3, false},
                                                   {"cm/s^2", 1e-2, false},
                                                   {"ft/s^2", 0.3048, false}}};

LikelyUnit likelyUnit(std::span<const NamedUnit> units, double read_as_si, double times, double tolerance) {
  LikelyUnit likely;
  for (const NamedUnit& unit : units) {
    const double error = std::abs(std::log(unit.si * times / read_as_si));
    if (unit.si == read_as_si || !(error < std::log1p(tolerance))) continue;
    if (likely.words.empty() && unit.in_sessions) likely.in_session = unit.name;
    likely.words += (likely.words.empty() ? "" : " or ") + std::string(unit.name);
  }
  return likely;
}

}  // namespace

LikelyUnit likelyUnit(AngularRateUnit read_as, double times, double tolerance) {
  return likelyUnit(kRateUnits, radiansPerSecond(read_as), times, tolerance);
}

LikelyUnit likelyUnit(AccelerationUnit read_as, double times, double tolerance) {
  return likelyUnit(kForceUnits, std::abs(metresPerSecond2(read_as)), times, tolerance);
}

bool lacksRate(const RawImuSample& sample) {
  return sample.measured_by == MeasuredBy::Accelerometer || isNothing(sample.angular_rate);
}

bool lacksForce(const RawImuSample& sample) {
  return sample.measured_by == MeasuredBy::Gyroscope || isNothing(sample.specific_force);
}

std::string axesText(const AxesReading& reading) {
  std::string text;
  for (const int axis : reading)
    text += std::string(text.empty() ? "" : ",") + (axis < 0 ? "-" : "") + "xyz"[std::abs(axis) - 1];
  return text;
}

std::optional<AxesReading> axesFrom(const std::string& text) {
  AxesReading reading = {};
  std::array<bool, 3> taken = {};
  std::size_t at = 0;
  for (std::size_t i = 0; i < reading.size(); ++i) {
    if (i > 0 && (at >= text.size() || text[at++] != ',')) return std::nullopt;
    while (at < text.size() && text[at] == ' ') ++at;
    const bool negated = at < text.size() && text[at] == '-';
    if (negated) ++at;
    if (at >= text.size() || text[at] < 'x' || text[at] > 'z') return std::nullopt;
    const int axis = text[at++] - 'x';
    if (taken[static_cast<std::size_t>(axis)]) return std::nullopt;
    taken[static_cast<std::size_t>(axis)] = true;
    reading[i] = negated ? -axis - 1 : axis + 1;
  }
  return at == text.size() ? std::optional(reading) : std::nullopt;
}

}  // namespace evical
