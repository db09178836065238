// One IMU sample in SI units, in the IMU's own frame.
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace evical {

// Which of the two sensors measured at a sample's time. Where they have samples of their own, the other's values are
// interpolated: good enough to be shown, never a measurement.
enum class MeasuredBy : std::uint8_t { Both, Gyroscope, Accelerometer };

struct ImuSample {
  std::int64_t time_ns = 0;
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  // +g upwards at rest
  MeasuredBy measured_by = MeasuredBy::Both;
};

}  // namespace evical
