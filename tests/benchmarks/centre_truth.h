// Errors of measured circle centres in simulated recordings, for benchmarks.
#pragma once

#include "core/data/board_observations.h"
#include "core/numerics/robust.h"
#include "core/synthetic/scenario.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace evical::benchmarks {

struct CentreError {
  Eigen::Vector2d error_px = Eigen::Vector2d::Zero(), velocity_px_s = Eigen::Vector2d::Zero(),
                  acceleration_px_s2 = Eigen::Vector2d::Zero(), from_mean_px = Eigen::Vector2d::Zero(),
                  lead_effect = Eigen::Vector2d::Zero();
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();
  double speed_px_s = 0.0;  // on the sensor
  std::size_t view = 0;
  double common_px = 0.0;  // stated: commonDisplacement_px
};

std::vector<CentreError> errorsOf(const Scenario& scenario, const BoardObservations& observations);

// Delay, lead, and one number more, by least squares; the few wild errors hardly count.
struct ErrorFit {
  double delay_s = 0.0, lead_px = 0.0, third = 0.0;
  double chi = 0.0;  // RMS of whitened errors that remain, with an ordinary weight
};

template <class Third>
ErrorFit fitErrors(const std::vector<CentreError>& errors, Third third) {
  constexpr double kWild2 = 36.0;  // squared errors over sigmas
  constexpr int kRounds = 4;
  ErrorFit fit;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d matrix = 1e-12 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    double squares = 0.0, weights = 0.0;
    for (const CentreError& error : errors) {
      Eigen::Matrix<double, 2, 3> row;
      row << -error.velocity_px_s, error.lead_effect, third(error);
      row = error.whitening * row;
      const Eigen::Vector2d seen = error.whitening * error.error_px;
      const double square = (seen - row * Eigen::Vector3d(fit.delay_s, fit.lead_px, fit.third)).squaredNorm();
      const double weight = round == 0 ? 1.0 : cauchyWeight(square / kWild2);
      matrix += weight * row.transpose() * row;
      vector += weight * row.transpose() * seen;
      squares += weight * square;
      weights += 2.0 * weight;
    }
    const Eigen::Vector3d solution = matrix.ldlt().solve(vector);
    fit = {solution.x(), solution.y(), solution.z(), std::sqrt(squares / std::max(weights, 1.0))};
  }
  return fit;
}

// The error that all circles of a window have in common, RMS over a fifth of the windows, the slowest first. Delay and lead
// are removed.
struct CommonErrors {
  double up_to_px_s = 0.0;
  double along_px = 0.0, across_px = 0.0;  // the motion
  double by_centres_px = 0.0;              // RMS an axis that the centres' covariances state for it
  double stated_px = 0.0;                  // with the common displacement of the batch
  double ratio() const {
    return std::hypot(along_px, across_px) / (std::sqrt(2.0) * std::max(1e-9, stated_px));
  }
};
std::array<CommonErrors, 5> commonErrors(const std::vector<CentreError>& errors, const ErrorFit& fit);

}  // namespace evical::benchmarks
