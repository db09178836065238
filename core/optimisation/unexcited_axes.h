// Axes of an IMU along which a recording contains only noise: scale and misalignment are undetermined there,
// and a free estimate takes the scale that hides other errors, down to 0.
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

  // Directions along which a displacement does not change a mounted sensor's motion: the axis of a rotation
  // about a single axis, and all directions without rotation.
  std::vector<Eigen::Vector3d> axesWithoutRotation() const;
};

// Uses the selected samples in the splines' range, compared with their noise in `weights`.
UnexcitedAxes stillAxes(const CalibrationInput& input, const CalibrationState& state, const Weights& weights,
                        std::size_t imu);

}  // namespace evical
