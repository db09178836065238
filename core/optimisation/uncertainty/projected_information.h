// Information of the measurements about the calibrated quantities, after the splines and the knots of
// drifting biases have been eliminated.
//
// With whitened Jacobians J_x (splines) and J_q (quantities), the projected Jacobian is
//   P = J_q - J_x (J_x^T J_x)^-1 J_x^T J_q,
// P^T P is the Schur complement, and an error e of the whitened measurements changes the estimate by (P^T
// P)^-1 P^T e. So P, by group and by stretch of time, also gives the effect of errors of another size, or of
// correlated errors.
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
  double residuals = 0.0;          // count
  double absorbed = 0.0;           // number that the unknowns absorb (trace of the hat matrix, estimated)

  // Variance of whitened errors, corrected for the fitted unknowns; 1 if the stated noise is right.
  double variance() const;
};

// Scatter of the scores of one camera's circles, summed by point of the board or by place in the image: sum
// of s s^T over the clusters. Its mean is the camera's information if errors are independent.
struct ClusterScatter {
  std::size_t camera = 0;
  bool by_place = false;
  int clusters = 0;
  Eigen::MatrixXd scatter;
};

struct ProjectedInformation {
  std::vector<Quantity> quantities;
  std::vector<Eigen::Index> first_column;  // of each quantity; one more for the end
  Eigen::MatrixXd total;                   // P^T P
  Eigen::VectorXd gradient;                // P^T r, r all residuals: 0 for free parameters at the optimum
  std::vector<MeasurementGroup> groups;
  // P^T e of the measurements in each stretch of time, with residuals scaled up for the absorbed part, and
  // P^T P.
  std::vector<Eigen::VectorXd> scores;
  std::vector<Eigen::MatrixXd> information_by_stretch;
  double first_stretch_s = 0.0, stretch_s = 0.0;  // begin of the first, and length of each
  // Mean contribution of the splines' own errors to P^T P. Without motion, derivatives still contain noise,
  // and squared noise looks like information.
  Eigen::MatrixXd from_noise;
  // Drifting biases, in the order of CalibrationProblem::driftBlocks: negative derivative of the knots by the
  // quantities, and the knots' covariance for known quantities. Empty for constant biases.
  Eigen::MatrixXd drift_by_quantities, drift_covariance;
  // By camera: P^T d, with d the change of the residuals by one sigma of the pixels' repeated errors.
  std::vector<Eigen::VectorXd> pixel_errors;
  std::vector<ClusterScatter> clusters;
};

// `problem` must be built. Scores are summed over stretches of `stretch_s`. The result does not depend on the
// number of threads. Throws Cancelled when asked to stop.
ProjectedInformation projectInformation(CalibrationProblem& problem, double stretch_s, int threads = 1,
                                        const RunContext& context = {});

}  // namespace evical
