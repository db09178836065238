// Uncertainty of the calibration (docs/maths.md, 10.1), and whether the motion supports it.
//
// Sigmas come from the Schur complement over the splines of the whitened Gauss-Newton information, with two
// corrections: each sensor's measurements have the variance of their residuals, and residuals close in time
// may be correlated: if their scores scatter more than uncorrelated ones (W. Newey, K. West, "A simple,
// positive semi-definite, heteroskedasticity and autocorrelation consistent covariance matrix", Econometrica
// 1987), a jackknife over blocks of time is used instead.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/quality_warning.h"

#include <string>
#include <vector>

namespace evical {

struct BatchSolution;
struct CalibrationInput;
struct OptimisationOptions;
struct RunContext;

struct UncertaintyEstimate {
  UncertaintyReport report;
  Eigen::MatrixXd as_weighed;  // QuantityCovariance::as_weighed, in the report's order
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;  // reason and advice; empty if Ok
  // Doubts about misaligned gyroscopes. Many other unmodelled errors look alike, so that they apply only if
  // those have been excluded.
  std::string turned_gyroscopes;
  std::string wandering_imus;  // IMUs with long-lasting errors, which look alike
  QualityWarning change;       // change within the recording, if it is more certain than such a misalignment
  std::string bent_board;      // doubts about a board assumed flat
  std::string wrong_lenses;    // fixed lenses
  std::string rolling_shutters;    // shutters declared global
  std::string other_sensors;       // cameras declared one sensor
  std::string scale_doubt;         // the board's size, or gravity
  std::string stretch_doubt;       // the board's stretch
  std::string bow_doubt;           // the board's bow
  std::vector<std::string> notes;  // remarks on the sigmas
};

// Only the sigmas, without their interpretation and tests: `given`, eigenvalues and directions stay empty.
UncertaintyReport estimateSigmas(const CalibrationInput& input, const BatchSolution& solution,
                                 const OptimisationOptions& options, const RunContext& context);

// Does not fail because of missing information: directions that the recording does not determine get
// sigmas far beyond any need.
UncertaintyEstimate estimateUncertainty(const CalibrationInput& input, const BatchSolution& solution,
                                        const OptimisationOptions& options, const RunContext& context);

}  // namespace evical
