// What the sources of perturbations have in common.
#pragma once

#include "core/synthetic/imu_simulator.h"
#include "tests/support/perturbations.h"

#include <algorithm>
#include <cstdint>
#include <random>

namespace evical::test {

// By what they perturb; perturbations() has them all.
std::vector<Perturbation> boardPerturbations();  // and gravity
std::vector<Perturbation> cameraPerturbations();
std::vector<Perturbation> clockPerturbations();
std::vector<Perturbation> imuPerturbations();

inline std::vector<ImuSample>& samplesOf(Recorded& recorded) {
  return recorded.pass.imus.front().samples;
}

template <class Change>
void changeSamples(Recorded& recorded, Change&& change) {
  for (ImuSample& sample : samplesOf(recorded)) change(sample);
}

inline void simulateImuAnew(Recorded& recorded) {
  samplesOf(recorded) = simulateImu(recorded.scenario, 0);
}

template <class Change>
void simulateFaults(Recorded& recorded, Change&& change) {
  change(recorded.scenario.imus.front().faults);
  simulateImuAnew(recorded);
}

inline std::size_t anySample(Recorded& recorded, std::mt19937_64& generator) {
  return std::uniform_int_distribution<std::size_t>(0, samplesOf(recorded).size() - 1)(generator);
}

}  // namespace evical::test
