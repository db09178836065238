// What is taken for constant, but may not have been: a camera that slips on its mount, a clock that steps, biases that
// walk. The scores of the solution, added up from a moment on, tell how far a quantity would step there if it were
// free to, and by how many sigmas (docs/maths.md, 10.8; D. Andrews, "Tests for parameter instability and structural
// change with unknown change point", Econometrica 1993). One linear step from what is there already: nothing is solved
// again.
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
  double at_s = 0.0;  // since the recording's start, to within some tenths of a second
  // From then on, SI: the offset; rotation about the reference's axes and translation; the gyroscope's biases and the
  // accelerometer's.
  Eigen::VectorXd change;
  // Beyond what as many numbers have by chance, and beyond what is left without a step to explain it.
  double sigmas = 0.0;
};

// For each sensor and kind the moment at which a change explains most; empty for recordings of less than three seconds.
// `information` is of what is estimated, and holds no value that is merely tested.
std::vector<SensorChange> findChanges(const ProjectedInformation& information);

// The most certain one that matters, beyond changed_sigmas and what is needed: of poses and clocks, with the larger part of
// the recording as what to calibrate instead, and of biases that are taken for constant.
struct ChangeDoubt {
  QualityWarning doubt;  // without a text: none
  double sigmas = 0.0;
};
ChangeDoubt doubtOfChanges(const CalibrationInput& input, const ProjectedInformation& information,
                           const OptimisationOptions& options);

}  // namespace evical
