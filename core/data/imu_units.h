// IMU samples as recorded, and their units in SI; -g is for drivers that report the direction of gravity.
#pragma once

#include "core/data/imu_sample.h"

#include "core/numerics/angles.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evical {

enum class AccelerationUnit { MetresPerSecond2, Gravity, MinusGravity };
enum class AngularRateUnit { RadiansPerSecond, DegreesPerSecond };

// Names in sessions and in `evical inspect`, in the enumerations' order.
inline constexpr std::array kAccelerationUnits{"m/s^2", "g", "-g"};
inline constexpr std::array kAngularRateUnits{"rad/s", "deg/s"};

inline constexpr double kStandardGravity_m_s2 = 9.80665;

constexpr double metresPerSecond2(AccelerationUnit unit) {
  if (unit == AccelerationUnit::MetresPerSecond2) return 1.0;
  return unit == AccelerationUnit::Gravity ? kStandardGravity_m_s2 : -kStandardGravity_m_s2;
}

constexpr double radiansPerSecond(AngularRateUnit unit) {
  return unit == AngularRateUnit::RadiansPerSecond ? 1.0 : kRadPerDeg;
}

// Axes of a sensor as the IMU's x, y and z: 2 is the sensor's y, -2 its negative y.
using AxesReading = std::array<int, 3>;
inline constexpr AxesReading kIdentityAxes = {1, 2, 3};

inline Eigen::Vector3d readAs(const AxesReading& reading, const Eigen::Vector3d& own) {
  const auto axis = [&](std::size_t i) {
    return reading[i] < 0 ? -own[-reading[i] - 1] : own[reading[i] - 1];
  };
  return {axis(0), axis(1), axis(2)};
}

// Composition: these axes applied to samples that were already converted by `first`.
inline AxesReading readAfter(const AxesReading& first, const AxesReading& then) {
  const auto axis = [&](std::size_t i) {
    const int own = first[static_cast<std::size_t>(then[i] < 0 ? -then[i] : then[i]) - 1];
    return then[i] < 0 ? -own : own;
  };
  return {axis(0), axis(1), axis(2)};
}

// Conversion to and from "y,x,-z"; empty if an axis is missing or repeated.
std::string axesText(const AxesReading& reading);
std::optional<AxesReading> axesFrom(const std::string& text);

// A sample of unknown units: the recorded numbers, in the IMU's own frame.
struct RawImuSample {
  std::int64_t time_ns = 0;
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();
  MeasuredBy measured_by = MeasuredBy::Both;
};

// True if a sample lacks the measurement of one sensor: because of its format, or since its values are all 0
// or not finite.
bool lacksRate(const RawImuSample& sample);
bool lacksForce(const RawImuSample& sample);

inline ImuSample toSi(const RawImuSample& raw, AccelerationUnit acceleration, AngularRateUnit rate) {
  return {raw.time_ns, raw.angular_rate * radiansPerSecond(rate),
          raw.specific_force * metresPerSecond2(acceleration), raw.measured_by};
}

// Appends to `samples`.
inline void toSi(std::span<const RawImuSample> raw, AccelerationUnit acceleration, AngularRateUnit rate,
                 std::vector<ImuSample>& samples) {
  for (const RawImuSample& sample : raw) samples.push_back(toSi(sample, acceleration, rate));
}

inline RawImuSample fromSi(const ImuSample& sample, AccelerationUnit acceleration, AngularRateUnit rate) {
  return {sample.time_ns, sample.angular_rate_rad_s / radiansPerSecond(rate),
          sample.specific_force_m_s2 / metresPerSecond2(acceleration), sample.measured_by};
}

}  // namespace evical
