// How sure the calibration is (docs/maths.md, 10.1), and whether the motion supports it.
//
// Sigmas come from the Schur complement over the splines of the whitened Gauss-Newton information. Two
// corrections keep them honest: each sensor's measurements count with the variance that their residuals show,
// and residuals near in time may be correlated: where more of them is left than uncorrelated ones leave (W. Newey,
// K. West, "A simple, positive semi-definite, heteroskedasticity and autocorrelation consistent covariance
// matrix", Econometrica 1987), a jackknife over blocks of time counts instead.
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
  std::string reason;  // why not Ok, and what to do; empty if it is
  // What is doubtful of gyroscopes that seem turned: much else that is not modelled looks like it, so that it is
  // for who has ruled that out.
  std::string turned_gyroscopes;
  std::string wandering_imus;  // of IMUs whose errors last, which looks much the same
  QualityWarning
      change;  // of what moved, or stepped, within the recording, where that is more certain than such turns
  std::string bent_board;          // the same of a board that is taken for flat
  std::string wrong_lenses;        // what is doubtful of lenses that are held
  std::string rolling_shutters;    // of those that are said to be global
  std::string other_sensors;       // of cameras that are said to be one sensor
  std::string scale_doubt;         // of the board's size, or gravity
  std::string stretch_doubt;       // of the board's stretch
  std::string bow_doubt;           // of how far it is bent
  std::vector<std::string> notes;  // what is worth knowing of the sigmas
};

// The sigmas alone, without what they mean and without tests: `given`, eigenvalues and directions stay empty.
UncertaintyReport estimateSigmas(const CalibrationInput& input, const BatchSolution& solution,
                                 const OptimisationOptions& options, const RunContext& context);

// Never fails for want of information: directions that the recording leaves open get
// sigmas far beyond any need.
UncertaintyEstimate estimateUncertainty(const CalibrationInput& input, const BatchSolution& solution,
                                        const OptimisationOptions& options, const RunContext& context);

}  // namespace evical
