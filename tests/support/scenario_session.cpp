#include "tests/support/scenario_session.h"

#include "core/frontend/board_tracker.h"
#include "core/frontend/detection_options.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "core/synthetic/session_errors.h"
#include "tests/support/seen_through.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

namespace evical::test {
namespace {

// The session's lens and noise, which need not be true.
DetectionResult passWith(const Scenario& scenario, const CameraIntrinsics& lens,
                         BoardObservations observations) {
  const Scenario said = asSessionSays(scenario);
  DetectionResult detections;
  detections.start_ns = scenario.start_ns;
  observations.camera = scenario.cameras.front().name;
  detections.cameras.push_back(std::move(observations));
  detections.lenses.push_back(givenLens(lens));
  for (std::size_t k = 0; k < scenario.imus.size(); ++k) {
    const SimulatedImu& imu = said.imus[k];
    detections.imus.push_back(
        {imu.name, {imu.gyroscope_density, imu.accelerometer_density}, simulateImu(scenario, k)});
  }
  return detections;
}

}  // namespace

Session sessionFor(const Scenario& truth) {
  const Scenario scenario = asSessionSays(truth);
  Session session;
  session.source = scenario.name;
  session.board = scenario.board;
  for (const SimulatedBoard& further : scenario.further_boards)
    session.further_boards.push_back({{further.name, further.board}});
  for (const SimulatedCamera& camera : scenario.cameras) {
    session.cameras.push_back(
        {camera.name, camera.stream, camera.intrinsics.resolution_px, camera.intrinsics});
    if (camera.frames && camera.frames->line_delay_us != 0.0)
      session.cameras.back().shutter = Shutter::Rolling;
    session.cameras.back().same_sensor_as = camera.same_sensor_as;
    if (!camera.same_sensor_as.empty()) session.cameras.back().intrinsics.reset();
    if (!scenario.further_boards.empty()) session.cameras.back().board = camera.board;
  }
  for (const SimulatedImu& imu : scenario.imus) {
    SessionImu out;
    out.name = imu.name;
    out.stream = imu.stream;
    out.noise = {imu.gyroscope_density, imu.accelerometer_density};
    session.imus.push_back(out);
  }
  session.reference = scenario.imus.empty() ? scenario.cameras.front().name : scenario.imus.front().name;
  return session;
}

DetectionResult detectedPass(const Scenario& scenario, const Session& session) {
  const CameraIntrinsics camera = asSessionSays(scenario).cameras.front().intrinsics;
  BoardTracker tracker(session.board, camera.resolution_px, camera, *session.options.front_end,
                       scenario.start_ns);
  simulateEvents(scenario, 0, [&](EventSpan events) { tracker.add(events); });
  return passWith(scenario, camera, tracker.finish());
}

DetectionResult perfectPass(const Scenario& scenario, double centre_sigma_px, double window_s) {
  const CameraIntrinsics &truth = scenario.cameras.front().intrinsics,
                         said = asSessionSays(scenario).cameras.front().intrinsics;
  BoardObservations observations = simulateObservations(scenario, 0, centre_sigma_px, window_s);
  if (said != truth) seeThrough(truth, said, observations);
  return passWith(scenario, said, std::move(observations));
}

NamedResult truthOf(const Scenario& scenario) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     fmt::format("evical_truth_{}_{}.yaml", scenario.name, scenario.seed);
  std::ofstream(file) << truthYaml(scenario);
  NamedResult truth = readResultYaml(file);
  std::filesystem::remove(file);
  return truth;
}

}  // namespace evical::test
