// One IMU sample in SI units, in the IMU's own frame.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace evical {

// Fewer samples show nothing about axes or units.
inline constexpr std::size_t kFewestImuSamples = 10;

// Which of the two sensors measured this sample. If they are sampled separately, the values of the other
// sensor are interpolated. They are for display only; no estimator uses them.
enum class MeasuredBy : std::uint8_t { Both, Gyroscope, Accelerometer };

struct ImuSample {
  std::int64_t time_ns = 0;
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  // +g upwards at rest
  MeasuredBy measured_by = MeasuredBy::Both;
};

// True if the sample contains the sensor's own measurement; also for RawImuSample.
template <class Sample>
bool measuresRate(const Sample& sample) {
  return sample.measured_by != MeasuredBy::Accelerometer;
}
template <class Sample>
bool measuresForce(const Sample& sample) {
  return sample.measured_by != MeasuredBy::Gyroscope;
}

}  // namespace evical
