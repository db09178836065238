// Samples of a simulated IMU: exact motion, scale and misalignment, biases, noise.
#pragma once

#include "core/synthetic/scenario.h"

#include "core/data/imu_sample.h"

#include <array>
#include <numbers>
#include <vector>

namespace evical {

struct SimulatedBiases {
  Eigen::Vector3d gyroscope_rad_s, accelerometer_m_s2;
};

// Stamps on the IMU's own clock, nanoseconds in the scenario's epoch; SI units.
std::vector<ImuSample> simulateImu(const Scenario& scenario, std::size_t imu);

// Means of the biases over all samples: biases are random walks that start at the scenario's values, and a
// gyroscope with g-sensitivity has a mean error.
SimulatedBiases meanBiases(const Scenario& scenario, std::size_t imu);

// Faults of a real IMU, its clock and its driver, added to ideal samples (ImuFaults).

// Output of a first-order filter for truth(time), minus its delay: delays are part of the clocks. The
// integral over its pulse response, by Gauss-Laguerre quadrature; unchanged for a cutoff of 0.
template <class Truth>
Eigen::Vector3d lowPassed(const Truth& truth, double time_s, double cutoff_hz) {
  if (cutoff_hz <= 0.0) return truth(time_s);
  constexpr std::array<std::array<double, 2>, 4> kNodesAndWeights = {
      {{0.322547689619392, 0.603154104341634},
       {1.745761101158346, 0.357418692437800},
       {4.536620296921128, 0.038887908515005},
       {9.395070912301133, 0.000539294705561}}};
  const double constant_s = 0.5 / (std::numbers::pi * cutoff_hz);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [node, weight] : kNodesAndWeights)
    sum += weight * truth(time_s + constant_s * (1.0 - node));
  return sum;
}

// Changes the measurements, then their stamps, then drops some. In time order.
void spoilSamples(const Scenario& scenario, std::size_t imu, std::vector<ImuSample>& samples);

}  // namespace evical
