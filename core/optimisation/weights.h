// Weights of the measurements in the batch, determined iteratively from their residuals.
#pragma once

#include "core/data/unfit_samples.h"
#include "core/optimisation/unexcited_axes.h"

#include <cstdint>
#include <vector>

namespace evical {

struct CalibrationInput;

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
