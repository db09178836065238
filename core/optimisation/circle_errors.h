// Reprojection errors of all measured circles, and the selection of inliers.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/weights.h"

#include <cmath>
#include <vector>

namespace evical {

// When a circle was measured, on the reference's clock.
inline double circleTime_s(const CameraState& camera, const CircleObservation& circle) {
  return referenceTime_s(camera, circle.time_s) + 1e-6 * camera.line_delay_us * circle.rows_below_middle +
         camera.exposure_share * circle.longer_exposed_s;
}

struct CircleError {
  std::size_t camera = 0, view = 0, index = 0;         // index: position in the view's list
  Eigen::Vector2d error_px = Eigen::Vector2d::Zero();  // predicted - measured, edge localisation bias
                                                       // included; known directions only
  double normalised2 =
      0.0;  // squared, over sigmas, without the displacement field of the view; infinite behind the camera
  int known_directions = 2;  // onlyKnownDirection: 1

  bool inFront() const { return std::isfinite(normalised2); }
};

// All circles whose times are in both splines' range, in order of camera, view and list. `used`: those that
// determine the displacement field of their view, as in the solution; null before a selection.
std::vector<CircleError> circleErrors(const CalibrationInput& input, const CalibrationState& state,
                                      const OptimisationOptions& options, const NoiseScales& scales,
                                      const CircleSelection* used = nullptr);

// The same for files and displays, with the circles that were not used.
std::vector<CircleResidual> circleResiduals(const CalibrationInput& input,
                                            const std::vector<CircleError>& errors,
                                            const CircleSelection& used);

// Size of the displacements of a camera's circles, in their expected sigmas: NoiseScales::displacements.
double displacementScale(const CalibrationInput& input, const CalibrationState& state,
                         const OptimisationOptions& options, const std::vector<CircleError>& errors,
                         const CircleSelection& used, std::size_t camera);

// Correlation of the errors of neighbouring circles of one view, mean over a camera's used circles.
double neighbourAgreement(const CalibrationInput& input, const CalibrationState& state,
                          const OptimisationOptions& options, const Weights& weights, std::size_t camera);

// Spread of a camera's errors in units of their sigmas, from the median, so that outliers
// don't matter; 1 without circles.
double robustScale(const std::vector<CircleError>& errors, std::size_t camera);

// Drops gross outliers, and views in which most circles are outliers. Circles outside
// the splines' range stay selected.
CircleSelection selectCircles(const CalibrationInput& input, const std::vector<CircleError>& errors,
                              const std::vector<double>& scales, const OptimisationOptions& options);

}  // namespace evical
