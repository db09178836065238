// What the measurements say of the calibrated quantities once the splines, and the biases' knots where these
// drift, have been eliminated.
//
// With whitened Jacobians J_x (splines) and J_q (quantities), the projected Jacobian is
//   P = J_q - J_x (J_x^T J_x)^-1 J_x^T J_q,
// P^T P is the Schur complement, and an error e of the whitened measurements moves the estimate by (P^T P)^-1
// P^T e. So P, taken group by group and stretch of time by stretch of time, also tells what errors of another
// size, or errors that are correlated, do to the estimate.
#pragma once

#include "core/base/progress.h"
#include "core/optimisation/parameter_blocks.h"
#include "core/optimisation/problem_builder.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

class CalibrationProblem;

// One kind of measurement of one sensor.
struct MeasurementGroup {
  SensorKind kind = SensorKind::Prior;
  std::size_t sensor = 0;
  Eigen::MatrixXd information;     // its share of P^T P
  double squared_residuals = 0.0;  // whitened
  double residuals = 0.0;          // how many
  double absorbed = 0.0;  // how many of them the unknowns absorb (trace of the hat matrix, estimated)

  // Variance of whitened residuals, had the unknowns not been fitted to them; 1 if all is as stated.
  double variance() const;
};

struct ProjectedInformation {
  std::vector<Quantity> quantities;
  std::vector<Eigen::Index> first_column;  // of each quantity; one more for the end
  Eigen::MatrixXd total;                   // P^T P
  Eigen::VectorXd gradient;                // P^T r, r all residuals: 0 by what is free at the optimum
  std::vector<MeasurementGroup> groups;
  // P^T e of the measurements in each stretch of time, residuals scaled up for what was absorbed, and P^T P.
  std::vector<Eigen::VectorXd> scores;
  std::vector<Eigen::MatrixXd> information_by_stretch;
  double first_stretch_s = 0.0, stretch_s = 0.0;  // when the first begins, and how long each is
  // What the splines' own errors add to P^T P on average. Where nothing moves the derivatives still hold
  // noise, and noise squared looks like information.
  Eigen::MatrixXd from_noise;
  // Of biases that drift, in the order of CalibrationProblem::driftBlocks: by how much the knots fall where
  // quantities rise, and the knots' covariance where these are known. Empty where biases are constant.
  Eigen::MatrixXd drift_by_quantities, drift_covariance;
  // By camera: P^T d, d what one sigma of the pixels' repeated errors changes in the residuals.
  std::vector<Eigen::VectorXd> pixel_errors;
};

// `problem` must be built. Scores are collected over stretches of `stretch_s`. The same for any number of threads. Throws
// Cancelled when asked to stop.
ProjectedInformation projectInformation(CalibrationProblem& problem, double stretch_s, int threads = 1,
                                        const RunContext& context = {});

}  // namespace evical
