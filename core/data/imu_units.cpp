#include "core/data/imu_units.h"

#include "core/data/quality_warning.h"

#include <cmath>
#include <cstdlib>
#include <span>

namespace evical {
namespace {

bool isNothing(const Eigen::Vector3d& values) {
  return values.isZero(0.0) || !values.allFinite();
}

struct NamedUnit {
  const char *name, *setting;
  double si;
};
constexpr std::array<NamedUnit, 7> kRateUnits = {{{"rad/s", "rad/s", 1.0},
                                                  {"deg/s", "deg/s", kRadPerDeg},
                                                  {"mrad/s", "0.001 rad/s", 1e-3},
                                                  {"mdeg/s", "0.001 deg/s", 1e-3 * kRadPerDeg},
                                                  {"deg/min", "0.0166667 deg/s", kRadPerDeg / 60.0},
                                                  {"deg/ms", "1000 deg/s", 1e3 * kRadPerDeg},
                                                  {"turns/min", "6 deg/s", 6.0 * kRadPerDeg}}};
constexpr std::array<NamedUnit, 6> kForceUnits = {{{"m/s^2", "m/s^2", 1.0},
                                                   {"g", "g", kStandardGravity_m_s2},
                                                   {"mg", "0.001 g", 1e-3 * kStandardGravity_m_s2},
                                                   {"mm/s^2", "0.001 m/s^2", 1e-3},
                                                   {"cm/s^2", "0.01 m/s^2", 1e-2},
                                                   {"ft/s^2", "0.3048 m/s^2", 0.3048}}};

LikelyUnit likelyUnit(std::span<const NamedUnit> units, double read_as_si, double times, double tolerance) {
  constexpr double kSame = 1e-6;
  LikelyUnit likely;
  for (const NamedUnit& unit : units) {
    if (std::abs(std::log(unit.si / read_as_si)) < kSame) continue;
    if (!(std::abs(std::log(unit.si * times / read_as_si)) < std::log1p(tolerance))) continue;
    likely.only = likely.words.empty();
    if (likely.only) likely.setting = unit.setting;
    likely.words += (likely.only ? "" : " or ") + std::string(unit.name);
  }
  return likely;
}

}  // namespace

LikelyUnit likelyRateUnit(double read_as_rad_s, double times, double tolerance) {
  return likelyUnit(kRateUnits, read_as_rad_s, times, tolerance);
}

LikelyUnit likelyAccelerationUnit(double read_as_m_s2, double times, double tolerance) {
  return likelyUnit(kForceUnits, read_as_m_s2, times, tolerance);
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
