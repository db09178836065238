// Calibration of an IMU from stops: at rest, |M^-1 (f - b)| is gravity's norm in any attitude, and the
// gyroscope measures its bias. docs/maths.md, 15.1.
#pragma once

#include "core/data/assessment.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_state.h"
#include "core/maintenance/stop_detection.h"
#include "core/numerics/change_test.h"

#include <Eigen/Core>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct MaintenanceOptions;

// Order: bias x, y, z [m/s^2]; scale x, y, z; misalignment xy, xz, yz (entries of M above the diagonal).
inline constexpr Eigen::Index kAccelerometerNumbers = 9;
inline constexpr std::array<StateBlock, 3> kAccelerometerBlocks = {{{0, 3}, {3, 3}, {6, 3}}};
using AccelerometerVector = Eigen::Matrix<double, kAccelerometerNumbers, 1>;
// Rows and columns of the six free entries of the accelerometer's mapping, in the order of the numbers after
// the bias.
inline constexpr std::array<std::array<int, 2>, 6> kMappingEntries = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
using AccelerometerMatrix = Eigen::Matrix<double, kAccelerometerNumbers, kAccelerometerNumbers>;

AccelerometerVector accelerometerNumbers(const ImuState& imu);
void setAccelerometerNumbers(const AccelerometerVector& numbers, ImuState& imu);
// Variances of an old result's values, including the tolerated changes.
AccelerometerVector accelerometerVariances(const ImuUncertainty& sigma, const MaintenanceOptions& options);

struct StopMean {
  double from_s = 0.0, to_s = 0.0;
  Eigen::Vector3d rate_rad_s, force_m_s2;
  double windows = 0.0;
};

struct StopCalibration {
  std::vector<StopMean> stops;
  std::vector<double> residuals_m_s2, sigmas_m_s2;  // of the stops, at `now`
  std::vector<char> used;
  AccelerometerVector before, now;
  AccelerometerMatrix covariance;  // of `now`, from stops and weak priors
  // At `before`, from stops only.
  AccelerometerMatrix information;
  AccelerometerVector score;
  double misfit = 0.0;         // RMS of normalised residuals per degree of freedom; 0: no degree of freedom
  std::string weakest;         // description of the direction
  double weakest_sigma = 0.0;  // in units of 0.01 m/s^2 and 0.001
  Eigen::Vector3d gyroscope_bias_rad_s, gyroscope_bias_sigma_rad_s;
};

// Tests several thresholds of stillness (D. Tedaldi et al., ICRA 2014), and uses the smallest one with the
// largest number of consistent stops. If there are no stops, `stops` is empty and the rest is undefined.
StopCalibration calibrateFromStops(std::span<const MeansWindow> windows, const ImuState& before,
                                   double gravity_m_s2, const MaintenanceOptions& options);

}  // namespace evical
