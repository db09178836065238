#include "core/data/imu_units.h"

#include <cstdlib>

namespace evical {
namespace {

bool isNothing(const Eigen::Vector3d& values) {
  return values.isZero(0.0) || !values.allFinite();
}

}  // namespace

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
