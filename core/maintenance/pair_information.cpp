#include "core/maintenance/pair_information.h"

#include "core/maintenance/maintenance_options.h"
#include "core/numerics/robust.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// Neighbouring points are at a distance of three sigmas of the smoothing: they share exp(-9/4) of their noise
// on either side.
const double kShared = 1.0 + 2.0 * std::exp(-2.25);

struct OwnFit {
  double squares = 0.0;
  int freedom = 0;

  double variance() const { return squares / freedom; }
};

// Residual of a window with all numbers estimated from it: noise, independent of changes.
OwnFit ownFit(const PairEquations& equations) {
  const PairVector scale = equations.information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const PairMatrix scaled = scale.asDiagonal() * equations.information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<PairMatrix> eigen(scaled);
  const PairVector along = eigen.eigenvectors().transpose() * scale.cwiseProduct(equations.score);
  constexpr double kLeast = 1e-8;
  OwnFit fit{equations.squares, equations.count};
  for (Eigen::Index i = 0; i < kPairNumbers; ++i) {
    if (eigen.eigenvalues()[i] < kLeast) continue;
    fit.squares -= along[i] * along[i] / eigen.eigenvalues()[i];
    --fit.freedom;
  }
  fit.squares = std::max(fit.squares, 0.0);
  return fit;
}

double typicalVariance(const std::vector<OwnFit>& fits) {
  constexpr int kFewest = 10;
  std::vector<double> variances;
  double freedom = 0.0;
  for (const OwnFit& fit : fits) {
    if (fit.freedom < kFewest) continue;
    variances.push_back(fit.variance());
    freedom += fit.freedom;
  }
  if (variances.empty()) return 0.0;
  // Median of chi squared divided by its degrees of freedom (E. B. Wilson, M. M. Hilferty 1931).
  const double mean_freedom = freedom / static_cast<double>(variances.size());
  return medianOf(std::move(variances)) / std::pow(1.0 - 2.0 / (9.0 * mean_freedom), 3);
}

// Reduces the weight of a window with far more noise than others (a shock, a spike).
double varianceOf(const OwnFit& fit, double typical, double restless) {
  return fit.freedom > 0 && fit.variance() > restless * typical ? fit.variance() : typical;
}

// Noise in the slope of the rate is in the lever's Jacobian and, times the lever, in the residual: its square
// imitates information for a lever of zero. Its expectation is subtracted; if it dominates, all of the
// information is removed.
void takeNoiseOff(const PairModel& model, double rate_variance, double force_variance, const PairWindow& raw,
                  double mostly_noise, PairEquations& gyroscope, PairEquations& accelerometer) {
  const double by_slope = 0.5 / (model.smoothing_s * model.smoothing_s);
  const double slope_variance = 0.5 * rate_variance * by_slope;  // of one of the two IMUs
  const double jerk_variance = 0.5 * force_variance * by_slope;
  const double points = raw.accelerometer.count / 3.0;
  const double turning = raw.gyroscope.information(6, 6);  // sum of the slopes' squares
  const bool tells = turning > mostly_noise * 3.0 * slope_variance * raw.gyroscope.count / 3.0;
  if (tells) {
    accelerometer.information.block<3, 3>(3, 3) -=
        2.0 * points * slope_variance * Eigen::Matrix3d::Identity();
    accelerometer.score.segment<3>(3) += 2.0 * points * slope_variance * model.lever_m;
  } else {
    accelerometer.information.middleRows<3>(3).setZero();
    accelerometer.information.middleCols<3>(3).setZero();
    accelerometer.score.segment<3>(3).setZero();
  }
  const auto withoutOffset = [&](PairEquations& equations, double noise) {
    if (equations.information(6, 6) > mostly_noise * noise) {
      equations.information(6, 6) -= noise;
      return;
    }
    equations.information.row(6).setZero();
    equations.information.col(6).setZero();
    equations.score[6] = 0.0;
  };
  withoutOffset(gyroscope, slope_variance * raw.gyroscope.count);
  withoutOffset(accelerometer, jerk_variance * raw.accelerometer.count);
}

}  // namespace

WeighedWindows weighed(std::span<const PairWindow> windows, const PairModel& model,
                       const MaintenanceOptions& options) {
  std::vector<OwnFit> rates, forces;
  for (const PairWindow& window : windows) {
    rates.push_back(ownFit(window.gyroscope));
    forces.push_back(ownFit(window.accelerometer));
  }
  constexpr double kLeast = 1e-20;
  const double rate_variance = std::max(typicalVariance(rates), kLeast),
               force_variance = std::max(typicalVariance(forces), kLeast);
  WeighedWindows all;
  all.gyroscope_noise_rad_s = std::sqrt(rate_variance);
  all.accelerometer_noise_m_s2 = std::sqrt(force_variance);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    PairEquations gyroscope = windows[w].gyroscope, accelerometer = windows[w].accelerometer;
    takeNoiseOff(model, rate_variance, force_variance, windows[w], options.mostly_noise, gyroscope,
                 accelerometer);
    const double by_rate = 1.0 / (kShared * varianceOf(rates[w], rate_variance, options.restless_window)),
                 by_force = 1.0 / (kShared * varianceOf(forces[w], force_variance, options.restless_window));
    WeighedWindow& each = all.windows.emplace_back();
    each.time_s = windows[w].time_s;
    each.information.topLeftCorner<kPairNumbers, kPairNumbers>() =
        by_rate * gyroscope.information + by_force * accelerometer.information;
    each.score.head<kPairNumbers>() = by_rate * gyroscope.score + by_force * accelerometer.score;
  }
  return all;
}

}  // namespace evical
