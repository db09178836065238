// Axes of an IMU about which a recording contains no rotation, only noise: translations along them, and a gyroscope's
// rotation relative to its accelerometer, are undetermined.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace evical {

struct CalibrationInput;
struct CalibrationState;
struct Weights;

// Unit vectors in the IMU's own frame, perpendicular to each other.
struct UnexcitedAxes {
  std::vector<Eigen::Vector3d> gyroscope;

  // Directions along which a displacement does not change a mounted sensor's motion: the axis of a rotation
  // about a single axis, and all directions without rotation.
  std::vector<Eigen::Vector3d> axesWithoutRotation() const;
};

// Uses the selected samples in the splines' range, compared with their noise in `weights`.
UnexcitedAxes stillAxes(const CalibrationInput& input, const CalibrationState& state, const Weights& weights,
                        std::size_t imu);

}  // namespace evical
