// Test for changes of quantities that are modelled as constant: a camera that slips on its mount, a clock
// that steps, biases that drift. The scores of the solution, added up from a moment on, determine the step of
// a quantity if it were free, and its significance (docs/maths.md, 10.8; D. Andrews, "Tests for parameter
// instability and structural change with unknown change point", Econometrica 1993). One linear step from the
// existing information, without another solution.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/quality_warning.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/projected_information.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace evical {

enum class ChangeKind { Clock, Pose, Biases };

struct SensorChange {
  ChangeKind kind = ChangeKind::Clock;
  QuantityOwner owner = QuantityOwner::Camera;
  std::size_t sensor = 0;
  double at_s = 0.0;  // since the recording's start; error of some tenths of a second
  // Change in SI units: the offset; rotation about the reference's axes and translation; the biases of
  // gyroscope and accelerometer.
  Eigen::VectorXd change;
  // Significance above chance for this many numbers, and above the residuals that no step explains.
  double sigmas = 0.0;
};

// For each sensor and kind the moment at which a change explains most; empty for recordings of less than
// three seconds. `information` contains estimated quantities only, not fixed ones that are merely tested.
std::vector<SensorChange> findChanges(const ProjectedInformation& information);

// The most certain change that exceeds changed_sigmas and the needed accuracy: of poses and clocks, with the
// larger part of the recording as the proposed time range, and of biases modelled as constant.
struct ChangeDoubt {
  QualityWarning doubt;  // empty text: no doubt
  double sigmas = 0.0;
};
ChangeDoubt doubtOfChanges(const CalibrationInput& input, const ProjectedInformation& information,
                           const OptimisationOptions& options);

}  // namespace evical
