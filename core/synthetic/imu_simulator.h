// Samples of a simulated IMU: exact motion, scale and misalignment, biases, noise.
#pragma once

#include "core/data/imu_sample.h"
#include "core/synthetic/scenario.h"

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

}  // namespace evical
