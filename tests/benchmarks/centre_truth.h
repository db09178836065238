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
#include <span>
#include <vector>

namespace evical::benchmarks {

struct CentreError {
  Eigen::Vector2d error_px = Eigen::Vector2d::Zero(), velocity_px_s = Eigen::Vector2d::Zero(),
                  acceleration_px_s2 = Eigen::Vector2d::Zero(), from_mean_px = Eigen::Vector2d::Zero(),
                  lead_effect = Eigen::Vector2d::Zero();
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();
  double speed_px_s = 0.0;  // on the sensor
  std::size_t view = 0;
  int circle = 0;
  Eigen::Vector2d place_spacings = Eigen::Vector2d::Zero();
};

std::vector<CentreError> errorsOf(const Scenario& scenario, const BoardObservations& observations);

// Windows of a board of squares with a corner that is nearer to the place of another one than to its own;
// only along directions in which the corner is known. Prints their times.
int wrongWindows(const Scenario& scenario, const BoardObservations& observations);

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

// Agreement of the errors of circles, over many recordings: by speed and distance on the board, and over
// time. Delay and lead are removed.
class ErrorAgreement {
 public:
  void add(const std::vector<CentreError>& errors, const ErrorFit& fit);
  void print() const;

 private:
  struct Left {
    Eigen::Vector2d px;
    const CentreError* error;
  };
  struct Mean {
    double sum = 0.0, weight = 0.0;
    void add(double value) { sum += value, ++weight; }
    double value() const { return weight > 0.0 ? sum / weight : 0.0; }
  };
  void addWindow(std::span<const Left> window);
  void addLater(std::span<const Left> window, std::span<const Left> later, std::size_t lag);

  static constexpr std::array<double, 6> kSpeeds_px_s = {0.0, 20.0, 40.0, 70.0, 120.0, 200.0};
  static constexpr std::array<double, 8> kDistances = {0.0, 0.1, 1.45, 2.05, 2.9, 4.0, 5.5, 8.0};  // spacings
  std::array<std::array<Mean, kDistances.size()>, kSpeeds_px_s.size()> products_px2_;
  std::array<Mean, kSpeeds_px_s.size()> stated_px2_;
  std::array<Mean, 5> circles_px2_, windows_px2_;  // 0 to 4 windows later; circles less their window's mean
};

}  // namespace evical::benchmarks
