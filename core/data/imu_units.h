// IMU samples as recordings have them, and what their units are in SI; -g for drivers that report the
// direction of gravity.
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

// As sessions and `evical inspect` spell them, in the enumerations' order.
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

// How a sensor's own axes are read as the IMU's x, y and z: 2 is its y, -2 the opposite of that.
using AxesReading = std::array<int, 3>;
inline constexpr AxesReading kIdentityAxes = {1, 2, 3};

inline Eigen::Vector3d readAs(const AxesReading& reading, const Eigen::Vector3d& own) {
  const auto axis = [&](std::size_t i) {
    return reading[i] < 0 ? -own[-reading[i] - 1] : own[reading[i] - 1];
  };
  return {axis(0), axis(1), axis(2)};
}

// What reading so is that has been read by `first` already.
inline AxesReading readAfter(const AxesReading& first, const AxesReading& then) {
  const auto axis = [&](std::size_t i) {
    const int own = first[static_cast<std::size_t>(then[i] < 0 ? -then[i] : then[i]) - 1];
    return then[i] < 0 ? -own : own;
  };
  return {axis(0), axis(1), axis(2)};
}

// "y,x,-z", and back: nothing where that is not each axis once.
std::string axesText(const AxesReading& reading);
std::optional<AxesReading> axesFrom(const std::string& text);

// A sample before its units are known: the recording's own numbers, in the IMU's own frame.
struct RawImuSample {
  std::int64_t time_ns = 0;
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();
  MeasuredBy measured_by = MeasuredBy::Both;
};

// Whether a sample has no measurement of one sensor: its format says so, or its values are all 0 or not finite.
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
