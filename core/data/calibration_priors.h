// Prior knowledge of a rig, sensor by sensor. A value with standard deviations is a prior that is combined
// with the recording's information; one without them is given: fixed, not estimated. Keys, units and frames
// as in a result: rotations and translations to the reference, sigmas of rotations about its axes.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>

namespace evical {

template <class Value, class Sigma = Value>
struct KnownValue {
  Value value;
  std::optional<Sigma> sigma = {};  // one for each number, all above 0; absent: given

  bool isGiven() const { return !sigma.has_value(); }
  bool operator==(const KnownValue&) const = default;
};
using KnownNumber = KnownValue<double>;
using KnownVector = KnownValue<Eigen::Vector3d>;
using KnownMapping = KnownValue<Eigen::Matrix3d>;  // upper triangular

struct KnownRotation {
  Eigen::Quaterniond value = Eigen::Quaterniond::Identity();
  std::optional<Eigen::Vector3d> sigma = {};  // rad

  bool isGiven() const { return !sigma.has_value(); }
  bool operator==(const KnownRotation& other) const {
    return value.coeffs() == other.value.coeffs() && sigma == other.sigma;
  }
};

template <class Known>
bool isGiven(const std::optional<Known>& known) {
  return known && known->isGiven();
}

struct SensorPrior {
  std::optional<KnownRotation> rotation;         // reference_from_sensor
  std::optional<KnownVector> translation;        // of reference_from_sensor, m
  std::optional<KnownNumber> time_offset;        // reference_time = sensor_time + it, s
  std::optional<KnownNumber> time_offset_drift;  // growth of time_offset, ppm

  bool operator==(const SensorPrior&) const = default;
};

struct ImuPrior : SensorPrior {
  std::optional<KnownVector> gyroscope_bias, accelerometer_bias;  // rad/s, m/s^2
  std::optional<KnownMapping> gyroscope_scale_misalignment, accelerometer_scale_misalignment;
  std::optional<KnownRotation> gyroscope_rotation;  // gyroscope_from_accelerometer, sigmas about its axes
  std::optional<KnownNumber> accelerometer_delay;   // s

  bool operator==(const ImuPrior&) const = default;
};

// Like SensorPrior::time_offset if time offsets are not estimated: fixed at a known value, or at 0.
inline KnownNumber heldTimeOffset(const SensorPrior& prior) {
  return {prior.time_offset ? prior.time_offset->value : 0.0};
}

}  // namespace evical
