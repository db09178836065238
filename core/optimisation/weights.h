// Weights of the measurements in the batch, determined iteratively from their residuals.
#pragma once

#include "core/data/unfit_samples.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace evical {

// Axes of an IMU about which a recording contains no rotation, only noise: translations along them, and a
// gyroscope's rotation relative to its accelerometer, are undetermined.

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

// Ratios of residuals to their given sigmas, per sensor. The batch divides its weights by them, so that wrong
// noise densities or circle covariances do not change the balance between camera and IMU.
struct NoiseScales {
  std::vector<double> circles;                          // by camera
  std::vector<double> displacements;                    // by camera: of the displacement field's sigmas
  std::vector<double> gyroscopes, accelerometers;       // by IMU
  double smooth_rotation = 1.0, smooth_position = 1.0;  // without an IMU: accelerations at the knots
};

using CircleFlags = std::vector<std::uint8_t>;
// used[camera][view][i]: circle i of the view's list is used.
using CircleSelection = std::vector<std::vector<CircleFlags>>;

struct Weights {
  NoiseScales scales;
  CircleSelection used_circles;
  std::vector<SampleSelection> used_samples;  // by IMU
  // By IMU: along these axes translations stay at 0.
  std::vector<UnexcitedAxes> held_axes;
};

CircleSelection allCircles(const CalibrationInput& input);

// Given noise, all circles, all fit samples, no fixed axes.
Weights givenWeights(const CalibrationInput& input);

}  // namespace evical
