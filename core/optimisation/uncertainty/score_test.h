// Score test of fixed quantities that the recording could determine: a gyroscope's misalignment, a lens, and
// the flatness of the board. The step of the estimate if it were free is compared with the step's sigma
// (Rao's score test).
#pragma once

#include "core/optimisation/uncertainty/projected_information.h"

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/numerics/robust.h"
#include "core/optimisation/optimisation_options.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

// The options with all tested quantities free.
OptimisationOptions freeToBeTested(OptimisationOptions options);

// Doubts; empty without any. `information` is of a solution in which the quantities that `options` fix are
// fixed, but are free columns.
struct HeldDoubts {
  std::string gyroscopes;  // significant misalignments above needed_rotation_deg
  double gyroscope_sigmas = 0.0;
  std::string wandering_imus;  // seemingly misaligned, but with lasting errors that this does not explain
  std::string lenses;          // significant projection errors above wrong_lens_px
  std::string board;           // significant bow above bent_board_mm
  std::string shutters;        // declared global, but rolling
};
HeldDoubts testHeldValues(const CalibrationInput& input, const CalibrationState& state,
                          const ProjectedInformation& information, const OptimisationOptions& options);

// The information if all fixed values are exact.
ProjectedInformation withoutHeldValues(const CalibrationInput& input, const OptimisationOptions& options,
                                       ProjectedInformation information);

// Scatter of the scores of stretches of time; equal to their information for white residuals and a correct
// model.

// Scores are summed over stretches of one correlation time. Weights fall to zero over the next three
// stretches, so that correlations of up to about that time count in full.
inline constexpr std::size_t kScoreLags = 3;

inline Eigen::MatrixXd scoreScatter(const std::vector<Eigen::VectorXd>& scores, Eigen::Index size) {
  return neweyWestByLag(scores, size, kScoreLags);
}

// Ratio of their variance to the information, mean over the numbers; 1 if model and sigmas are correct.
inline double scatterRatio(const Eigen::MatrixXd& scatter, const Eigen::MatrixXd& information) {
  constexpr double kNone = 1e-300;
  return scatter.diagonal().cwiseQuotient(information.diagonal().cwiseMax(kNone)).mean();
}

}  // namespace evical
