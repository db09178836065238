// How much each measurement counts in the batch: found from its residuals, round by round.
#pragma once

#include "core/data/unfit_samples.h"
#include "core/optimisation/unexcited_axes.h"

#include <cstdint>
#include <vector>

namespace evical {

struct CalibrationInput;

// How much larger residuals are than the sigmas given for them, per sensor. The batch divides its weights by
// these, so that wrong noise densities or circle covariances don't decide between camera and IMU.
struct NoiseScales {
  std::vector<double> circles;                          // by camera
  std::vector<double> gyroscopes, accelerometers;       // by IMU
  double smooth_rotation = 1.0, smooth_position = 1.0;  // without an IMU: accelerations at the knots
};

// used[camera][view][i]: circle i of the view's list takes part.
using CircleSelection = std::vector<std::vector<std::vector<std::uint8_t>>>;

struct Weights {
  NoiseScales scales;
  CircleSelection used_circles;
  std::vector<SampleSelection> used_samples;  // by IMU
  // By IMU: along these a mapping stays as it is, and translations stay at 0.
  std::vector<UnexcitedAxes> held_axes;
};

CircleSelection allCircles(const CalibrationInput& input);

// Noise as it is given, all circles, all samples that are fit, nothing held.
Weights givenWeights(const CalibrationInput& input);

}  // namespace evical
