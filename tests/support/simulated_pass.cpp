#include "tests/support/simulated_pass.h"

#include "core/synthetic/board_truth.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"

namespace evical::test {
namespace {

constexpr double kNoise_px = 0.05, kWindow_s = 0.02;

BoardObservations observationsOf(const Scenario& scenario, std::size_t camera) {
  BoardObservations observations = simulateObservations(scenario, camera, kNoise_px, kWindow_s);
  observations.camera = scenario.cameras[camera].name;
  if (scenario.cameras[camera].frames) observations.kind = CameraKind::Frames;
  return observations;
}

}  // namespace

SimulatedPass simulatePass(double duration_s, const std::string& scenario) {
  return simulatePass(duration_s, readScenario(scenarioPath(scenario)));
}

SimulatedPass simulatePass(double duration_s, const Scenario& scenario) {
  SimulatedPass simulated;
  simulated.truth = scenario;
  simulated.truth.duration_s = duration_s;
  simulated.session = sessionFor(simulated.truth);
  simulated.session.source = "session.yaml";
  simulated.detections.start_ns = simulated.truth.start_ns;
  for (std::size_t k = 0; k < simulated.truth.cameras.size(); ++k) {
    simulated.detections.cameras.push_back(observationsOf(simulated.truth, k));
    simulated.detections.lenses.push_back(givenLens(simulated.truth.cameras[k].intrinsics));
    simulated.detections.resolutions_px.push_back(simulated.truth.cameras[k].intrinsics.resolution_px);
  }
  for (std::size_t k = 0; k < simulated.truth.imus.size(); ++k) {
    const SessionImu& imu = simulated.session.imus[k];
    simulated.detections.imus.push_back({imu.name, imu.noise, simulateImu(simulated.truth, k)});
  }
  return simulated;
}

}  // namespace evical::test
