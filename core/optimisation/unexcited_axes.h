// Axes of an IMU along which a recording holds no more than noise: nothing there tells scale or misalignment,
// and an estimate that is free to choose takes the scale that hides other errors, down to 0.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace evical {

struct CalibrationInput;
struct CalibrationState;
struct Weights;

// Unit vectors in the IMU's own frame, perpendicular to each other.
struct UnexcitedAxes {
  std::vector<Eigen::Vector3d> gyroscope, accelerometer;

  // Where what is mounted there moves the same wherever along them it is: the axis of a rotation that has
  // only one, and all without rotation.
  std::vector<Eigen::Vector3d> axesWithoutRotation() const;
};

// Samples that are used and lie in the splines' range, against their noise as `weights` have it.
UnexcitedAxes stillAxes(const CalibrationInput& input, const CalibrationState& state, const Weights& weights,
                        std::size_t imu);

}  // namespace evical
