// What a unit of a recording's IMU numbers is in SI; -g for drivers that report the direction of gravity.
#pragma once

#include "core/data/imu_sample.h"

#include <array>
#include <numbers>
#include <span>

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
  return unit == AngularRateUnit::RadiansPerSecond ? 1.0 : std::numbers::pi / 180.0;
}

inline void toSi(AccelerationUnit acceleration, AngularRateUnit rate, std::span<ImuSample> samples) {
  for (ImuSample& sample : samples) {
    sample.specific_force_m_s2 *= metresPerSecond2(acceleration);
    sample.angular_rate_rad_s *= radiansPerSecond(rate);
  }
}

}  // namespace evical
