#include "core/maintenance/stop_calibration.h"

#include "core/maintenance/maintenance_options.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace evical {
namespace {

// Weak priors: 0.1 g and 5 %.
constexpr double kOpenBias_m_s2 = 1.0, kOpenScale = 0.05;
// Units that make biases and scales comparable.
constexpr double kBiasUnit_m_s2 = 1e-2, kScaleUnit = 1e-3;
constexpr std::array<const char*, kAccelerometerNumbers> kWords = {
    "bias x",  "bias y",          "bias z",          "scale x",        "scale y",
    "scale z", "misalignment xy", "misalignment xz", "misalignment yz"};

// Variances of the windows' means about the mean of their stop.
struct StopNoise {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
};

StopMean meanOf(std::span<const MeansWindow> windows, const StopRange& range) {
  StopMean mean;
  mean.from_s = windows[range.first].time_s;
  mean.to_s = windows[range.last].time_s + WindowMeans::kLength_s;
  mean.windows = static_cast<double>(range.count());
  mean.rate_rad_s = mean.force_m_s2 = Eigen::Vector3d::Zero();
  for (std::size_t i = range.first; i <= range.last; ++i) {
    mean.rate_rad_s += windows[i].rate_rad_s / mean.windows;
    mean.force_m_s2 += windows[i].force_m_s2 / mean.windows;
  }
  return mean;
}

// Scatter of windows about the mean of their stop, pooled over these stops. It is increased if neighbours are
// correlated, since the variance of a mean then decreases more slowly.
StopNoise noiseOf(std::span<const MeansWindow> windows, std::span<const StopRange> ranges,
                  std::span<const StopMean> means, const std::vector<std::size_t>& stops) {
  StopNoise noise;
  Eigen::Vector3d rate_pairs = Eigen::Vector3d::Zero(), force_pairs = Eigen::Vector3d::Zero();
  double freedom = 0.0, pairs = 0.0;
  for (const std::size_t s : stops) {
    for (std::size_t i = ranges[s].first; i <= ranges[s].last; ++i) {
      const Eigen::Vector3d rate = windows[i].rate_rad_s - means[s].rate_rad_s,
                            force = windows[i].force_m_s2 - means[s].force_m_s2;
      noise.rate += rate.cwiseAbs2();
      noise.force += force.cwiseAbs2();
      if (i == ranges[s].first) continue;
      rate_pairs += rate.cwiseProduct(windows[i - 1].rate_rad_s - means[s].rate_rad_s);
      force_pairs += force.cwiseProduct(windows[i - 1].force_m_s2 - means[s].force_m_s2);
      pairs += 1.0;
    }
    freedom += means[s].windows - 1.0;
  }
  freedom = std::max(freedom, 1.0);
  noise.rate /= freedom;
  noise.force /= freedom;
  // Subtracting the mean causes a correlation of -1 / windows between neighbours of white noise.
  const double bias = static_cast<double>(stops.size()) / std::max(pairs, 1.0);
  const auto inflate = [&](Eigen::Vector3d& variance, const Eigen::Vector3d& sum) {
    for (int axis = 0; axis < 3; ++axis) {
      const double alike = sum[axis] / std::max(pairs, 1.0) + bias * variance[axis];
      // Ignores a correlation that one lag of a few hundred pairs shows by chance.
      const double share = variance[axis] > 0.0 ? alike / variance[axis] : 0.0;
      if (share > 3.0 / std::sqrt(std::max(pairs, 1.0)))
        variance[axis] *= (1.0 + share) / (1.0 - std::min(share, 0.9));
    }
  };
  inflate(noise.rate, rate_pairs);
  inflate(noise.force, force_pairs);
  constexpr double kMinVariance = 1e-12;
  noise.force = noise.force.cwiseMax(kMinVariance);
  return noise;
}

// Noise of each stop. The gyroscope identifies hand-held stops; their noise is estimated separately.
std::vector<StopNoise> noisesOf(std::span<const MeansWindow> windows, std::span<const StopRange> ranges,
                                std::span<const StopMean> means) {
  constexpr double kByHand = 4.0;  // times the variance of the quietest stop
  std::vector<double> restless;
  for (const StopRange& range : ranges) {
    double sum = 0.0;
    for (std::size_t i = range.first; i <= range.last; ++i) sum += windows[i].rate_variance;
    restless.push_back(sum / static_cast<double>(range.count()));
  }
  const double quietest = *std::min_element(restless.begin(), restless.end());
  std::array<std::vector<std::size_t>, 2> kinds;
  for (std::size_t s = 0; s < ranges.size(); ++s)
    kinds[restless[s] > kByHand * quietest ? 1 : 0].push_back(s);
  std::vector<StopNoise> noises(ranges.size());
  for (const std::vector<std::size_t>& stops : kinds) {
    if (stops.empty()) continue;
    const StopNoise noise = noiseOf(windows, ranges, means, stops);
    for (const std::size_t s : stops) noises[s] = noise;
  }
  return noises;
}

// Residual of |M^-1 (f - b)| minus gravity's norm; its derivative by the nine numbers, and its sigma.
struct StopResidual {
  double value = 0.0, sigma = 0.0;
  AccelerometerVector row;
};

StopResidual residualOf(const StopMean& stop, const StopNoise& noise, const AccelerometerVector& numbers,
                        double gravity_m_s2) {
  ImuState imu;
  setAccelerometerNumbers(numbers, imu);
  const Eigen::Matrix3d inverse = imu.accelerometer_scale_misalignment.inverse();
  const Eigen::Vector3d force = inverse * (stop.force_m_s2 - imu.accelerometer_bias_m_s2);
  const Eigen::Vector3d along = inverse.transpose() * force.normalized();
  StopResidual residual;
  residual.value = force.norm() - gravity_m_s2;
  residual.sigma = std::sqrt(along.cwiseAbs2().dot(noise.force) / stop.windows);
  residual.row.head<3>() = -along;
  for (std::size_t e = 0; e < kMappingEntries.size(); ++e)
    residual.row[3 + static_cast<Eigen::Index>(e)] =
        -along[kMappingEntries[e][0]] * force[kMappingEntries[e][1]];
  return residual;
}

AccelerometerVector openInformation() {
  AccelerometerVector information;
  information.head<3>().setConstant(1.0 / (kOpenBias_m_s2 * kOpenBias_m_s2));
  information.tail<6>().setConstant(1.0 / (kOpenScale * kOpenScale));
  return information;
}

struct NormalEquations {
  AccelerometerMatrix information = AccelerometerMatrix::Zero();
  AccelerometerVector score = AccelerometerVector::Zero();
};

NormalEquations equationsAt(const StopCalibration& found, const std::vector<StopNoise>& noises,
                            const AccelerometerVector& numbers, double gravity_m_s2) {
  NormalEquations sum;
  for (std::size_t s = 0; s < found.stops.size(); ++s) {
    if (found.used[s] == 0) continue;
    const StopResidual r = residualOf(found.stops[s], noises[s], numbers, gravity_m_s2);
    const double weight = 1.0 / (r.sigma * r.sigma);
    sum.information += weight * r.row * r.row.transpose();
    sum.score -= weight * r.value * r.row;
  }
  return sum;
}

void solve(StopCalibration& found, const std::vector<StopNoise>& noises, double gravity_m_s2) {
  constexpr int kSteps = 10;
  const AccelerometerVector open = openInformation();
  found.now = found.before;
  for (int step = 0; step < kSteps; ++step) {
    const NormalEquations sum = equationsAt(found, noises, found.now, gravity_m_s2);
    const AccelerometerMatrix whole = sum.information + AccelerometerMatrix(open.asDiagonal());
    const Eigen::LDLT<AccelerometerMatrix> solver(whole);
    found.covariance = solver.solve(AccelerometerMatrix::Identity());
    const AccelerometerVector change = solver.solve(sum.score + open.cwiseProduct(found.before - found.now));
    found.now += change;
    if (change.cwiseAbs().maxCoeff() < 1e-10) break;
  }
  for (std::size_t s = 0; s < found.stops.size(); ++s) {
    const StopResidual r = residualOf(found.stops[s], noises[s], found.now, gravity_m_s2);
    found.residuals_m_s2[s] = r.value;
    found.sigmas_m_s2[s] = r.sigma;
  }
}

// Effective number of parameters that the stops determine, without the weak priors.
double determined(const StopCalibration& found) {
  const AccelerometerMatrix held = found.covariance * openInformation().asDiagonal();
  return static_cast<double>(kAccelerometerNumbers) - held.trace();
}

struct Misfit {
  double rms = 0.0, inflation = 1.0;  // of variances
};

Misfit misfitOf(const StopCalibration& found) {
  double sum = 0.0, count = 0.0;
  for (std::size_t s = 0; s < found.stops.size(); ++s) {
    if (found.used[s] == 0) continue;
    sum += std::pow(found.residuals_m_s2[s] / found.sigmas_m_s2[s], 2);
    count += 1.0;
  }
  const double freedom = count - determined(found);
  if (freedom < 0.9) return {};
  // The scatter between stops includes small accelerations by hands.
  return {std::sqrt(sum / freedom), std::max(sum / freedom, 1.0)};
}

// Constant acceleration in a ride looks like a stop. Drops stops that the others contradict, up to a limit.
void dropOutliers(StopCalibration& found, const std::vector<StopNoise>& noises, double gravity_m_s2,
                  const MaintenanceOptions& options) {
  const auto most = static_cast<int>(options.left_out_stops * static_cast<double>(found.stops.size()));
  for (int dropped = 0; dropped < most; ++dropped) {
    std::size_t worst = found.stops.size();
    double furthest = options.far_stop_sigmas;
    for (std::size_t s = 0; s < found.stops.size(); ++s) {
      const double far = std::abs(found.residuals_m_s2[s]) / found.sigmas_m_s2[s];
      if (found.used[s] != 0 && far > furthest) {
        furthest = far;
        worst = s;
      }
    }
    if (worst == found.stops.size()) return;
    found.used[worst] = 0;
    solve(found, noises, gravity_m_s2);
  }
}

void nameWeakest(StopCalibration& found) {
  AccelerometerVector unit;
  unit.head<3>().setConstant(1.0 / kBiasUnit_m_s2);
  unit.tail<6>().setConstant(1.0 / kScaleUnit);
  const AccelerometerMatrix scaled = unit.asDiagonal() * found.covariance * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<AccelerometerMatrix> eigen(scaled);
  const AccelerometerVector axis = eigen.eigenvectors().col(kAccelerometerNumbers - 1);
  found.weakest_sigma = std::sqrt(std::max(eigen.eigenvalues()[kAccelerometerNumbers - 1], 0.0));
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < kAccelerometerNumbers; ++i)
    if (std::abs(axis[i]) > 0.4) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return std::abs(axis[a]) > std::abs(axis[b]); });
  for (const Eigen::Index i : order) {
    const bool against = axis[i] * axis[order.front()] < 0.0;
    found.weakest += fmt::format("{}{}{}", found.weakest.empty() ? "" : " and ", against ? "opposite " : "",
                                 kWords[static_cast<std::size_t>(i)]);
  }
}

// Stops differ by the random walk of the bias, in addition to their noise.
void setGyroscopeBias(StopCalibration& found, const std::vector<StopNoise>& noises) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = sum, by_noise = sum;
  double windows = 0.0;
  for (const StopMean& stop : found.stops) {
    sum += stop.windows * stop.rate_rad_s;
    windows += stop.windows;
  }
  found.gyroscope_bias_rad_s = sum / windows;
  for (std::size_t s = 0; s < found.stops.size(); ++s) {
    const StopMean& stop = found.stops[s];
    squares += (stop.windows / windows) * (stop.rate_rad_s - found.gyroscope_bias_rad_s).cwiseAbs2();
    by_noise += stop.windows / (windows * windows) * noises[s].rate;
  }
  const auto count = static_cast<double>(found.stops.size());
  const Eigen::Vector3d by_scatter = squares / std::max(count - 1.0, 1.0);
  found.gyroscope_bias_sigma_rad_s = by_noise.cwiseMax(by_scatter).cwiseSqrt();
}

StopCalibration calibrate(std::span<const MeansWindow> windows, std::span<const StopRange> ranges,
                          const ImuState& before, double gravity_m_s2, const MaintenanceOptions& options) {
  StopCalibration found;
  if (ranges.empty()) return found;
  for (const StopRange& range : ranges) found.stops.push_back(meanOf(windows, range));
  const std::vector<StopNoise> noises = noisesOf(windows, ranges, found.stops);
  found.used.assign(found.stops.size(), 1);
  found.residuals_m_s2.resize(found.stops.size());
  found.sigmas_m_s2.resize(found.stops.size());
  found.before = accelerometerNumbers(before);
  solve(found, noises, gravity_m_s2);
  dropOutliers(found, noises, gravity_m_s2, options);
  const Misfit misfit = misfitOf(found);
  found.misfit = misfit.rms;
  const NormalEquations at_before = equationsAt(found, noises, found.before, gravity_m_s2);
  // A scatter of stops that exceeds their noise increases all sigmas.
  found.information = at_before.information / misfit.inflation;
  found.score = at_before.score / misfit.inflation;
  found.covariance *= misfit.inflation;
  nameWeakest(found);
  setGyroscopeBias(found, noises);
  return found;
}

}  // namespace

AccelerometerVector accelerometerNumbers(const ImuState& imu) {
  AccelerometerVector numbers;
  numbers.head<3>() = imu.accelerometer_bias_m_s2;
  for (std::size_t e = 0; e < kMappingEntries.size(); ++e)
    numbers[3 + static_cast<Eigen::Index>(e)] =
        imu.accelerometer_scale_misalignment(kMappingEntries[e][0], kMappingEntries[e][1]);
  return numbers;
}

void setAccelerometerNumbers(const AccelerometerVector& numbers, ImuState& imu) {
  imu.accelerometer_bias_m_s2 = numbers.head<3>();
  for (std::size_t e = 0; e < kMappingEntries.size(); ++e)
    imu.accelerometer_scale_misalignment(kMappingEntries[e][0], kMappingEntries[e][1]) =
        numbers[3 + static_cast<Eigen::Index>(e)];
}

AccelerometerVector accelerometerVariances(const ImuUncertainty& sigma, const MaintenanceOptions& options) {
  const auto squared = [](double a) { return std::isfinite(a) ? a * a : 0.0; };
  AccelerometerVector variances;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    variances[axis] =
        squared(sigma.accelerometer_bias_std_m_s2[axis]) + squared(options.stability_accelerometer_bias_m_s2);
  for (std::size_t e = 0; e < kMappingEntries.size(); ++e)
    variances[3 + static_cast<Eigen::Index>(e)] =
        squared(sigma.accelerometer_scale_misalignment_std(kMappingEntries[e][0], kMappingEntries[e][1])) +
        squared(options.stability_imu_scale);
  return variances.cwiseMax(1e-12);
}

StopCalibration calibrateFromStops(std::span<const MeansWindow> windows, const ImuState& before,
                                   double gravity_m_s2, const MaintenanceOptions& options) {
  constexpr std::array kThresholds = {1.0, 1.5, 2.0, 3.0};  // of options.stop_above_quietest
  StopCalibration best;
  std::ptrdiff_t most = 0;
  for (const double times : kThresholds) {
    const std::vector<StopRange> ranges = findStops(windows, times * options.stop_above_quietest, options);
    StopCalibration found = calibrate(windows, ranges, before, gravity_m_s2, options);
    const std::ptrdiff_t used = std::count(found.used.begin(), found.used.end(), 1);
    if (used <= most) continue;
    most = used;
    best = std::move(found);
  }
  return best;
}

}  // namespace evical
