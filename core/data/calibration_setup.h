// Input of a calibration: the sensors by name, the board, the noise. Several cameras and IMUs are always
// supported.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/camera_lens.h"
#include "core/data/imu_sample.h"

#include "core/geometry/board.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Prior knowledge of a rig, sensor by sensor. A value with standard deviations is a prior that is combined
// with the recording's information; one without them is given: fixed, not estimated. Keys, units and frames
// as in a result: rotations and translations to the reference, sigmas of rotations about its axes.
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

// Continuous-time densities, Kalibr's model: a sample's sigma is density * sqrt(rate).
struct ImuNoise {
  double gyroscope_density = 1.87e-4;      // rad/s/sqrt(Hz)
  double accelerometer_density = 1.86e-3;  // m/s^2/sqrt(Hz)
  double gyroscope_random_walk = 0.0;      // of the bias, rad/s^2/sqrt(Hz); 0: unknown
  double accelerometer_random_walk = 0.0;  // m/s^3/sqrt(Hz)

  bool operator==(const ImuNoise&) const = default;
};

struct ImuData {
  std::string name;
  ImuNoise noise;
  std::vector<ImuSample> samples;  // in time order
  ImuPrior prior = {};

  // Sample rates of the two sensors. The gyroscope's rate is reported as the IMU's. Linear in the number of
  // samples.
  double rate_hz() const { return rateOf_hz(measuresRate<ImuSample>); }
  double accelerometerRate_hz() const { return rateOf_hz(measuresForce<ImuSample>); }
  // Noise of one sample, per axis. Linear in the number of samples.
  double gyroscopeSigma_rad_s() const { return noise.gyroscope_density * std::sqrt(rate_hz()); }
  double accelerometerSigma_m_s2() const {
    return noise.accelerometer_density * std::sqrt(accelerometerRate_hz());
  }

 private:
  // Between the first and the last sample of this sensor.
  template <class Measures>
  double rateOf_hz(Measures measures) const {
    const auto count = std::count_if(samples.begin(), samples.end(), measures);
    if (count < 2) return 0.0;
    const auto first = std::find_if(samples.begin(), samples.end(), measures);
    const auto last = std::find_if(samples.rbegin(), samples.rend(), measures);
    return static_cast<double>(count - 1) * 1e9 / static_cast<double>(last->time_ns - first->time_ns);
  }
};

// Exposure of a frame camera: all rows at once, or one after the other.
enum class Shutter { Global, Rolling };

// A board in addition to the one whose frame is the world; it does not move relative to that one.
struct AdditionalBoard {
  std::string name;
  Board board;
  std::optional<double> spacing_std = {};  // relative; absent: the same as the world board's
};

// The board in this camera's view: its index as in CalibrationState::boardAt.
struct SeenBoard {
  Board board;
  std::size_t index = 0;
};

struct CameraData {
  std::string name;
  CameraLens lens;
  BoardObservations observations;  // in the ideal pixels of lens.detection_intrinsics
  SensorPrior prior = {};
  Shutter shutter = Shutter::Global;
  // Another camera on the same chip (a DAVIS's events and frames): one pose, one lens, one clock, but
  // separate time offsets. Empty for that camera.
  std::optional<std::size_t> same_sensor_as = {};
  std::size_t board = 0;  // in this camera's view: CalibrationInput::boardAt
};

// The estimator's input. Times of observations are seconds since start_ns;
// IMU samples keep their nanoseconds.
struct CalibrationInput {
  std::int64_t start_ns = 0;
  std::string board_name = "board";
  Board board;  // its frame is the world
  std::vector<AdditionalBoard> further_boards = {};
  std::vector<CameraData> cameras;
  std::vector<ImuData> imus;
  std::size_t reference_imu = 0;     // index into imus
  std::size_t reference_camera = 0;  // index into cameras: the reference if there is no IMU
  double gravity_norm_m_s2 = 9.81;   // mean of its prior in the batch

  // The camera that represents this camera's chip: itself, unless it shares the chip of another one.
  std::size_t sensorOf(std::size_t camera) const { return cameras[camera].same_sensor_as.value_or(camera); }
  // Index 0 is the world's board.
  const Board& boardAt(std::size_t board_index) const {
    return board_index == 0 ? board : further_boards.at(board_index - 1).board;
  }
  const Board& boardOf(std::size_t camera) const { return boardAt(cameras[camera].board); }
  const std::string& boardName(std::size_t board_index) const {
    return board_index == 0 ? board_name : further_boards.at(board_index - 1).name;
  }
  // Key in a session: "board", or the name of one of several.
  std::string boardKey(std::size_t board_index) const {
    return further_boards.empty() ? "board" : "boards." + boardName(board_index);
  }
  // For messages: "board", "board tags".
  std::string boardWords(std::size_t board_index) const {
    return further_boards.empty() ? "board" : "board " + boardName(board_index);
  }
  // Relative sigma of a board's spacing, given that of the world's board.
  double spacingSigma(std::size_t board_index, double of_world) const {
    return board_index == 0 ? of_world : further_boards.at(board_index - 1).spacing_std.value_or(of_world);
  }
  std::size_t boardCount() const { return 1 + further_boards.size(); }
  // The camera whose board is the world: the reference, or the first one if the reference is an IMU.
  std::size_t worldCamera() const { return imus.empty() ? reference_camera : 0; }
  // True if this camera is the reference of the rig.
  bool isReferenceCamera(std::size_t camera) const { return imus.empty() && camera == reference_camera; }
  bool isReferenceImu(std::size_t imu) const { return imu == reference_imu; }
};

}  // namespace evical
