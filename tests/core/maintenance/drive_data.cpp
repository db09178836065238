#include "tests/core/maintenance/drive_data.h"

#include "core/base/time.h"
#include "core/synthetic/drive_simulator.h"
#include "tests/support/test_folders.h"

#include <cmath>

namespace evical::test {

DriveScenario driveScenario(const std::string& name, std::uint64_t seed) {
  DriveScenario scenario = readDriveScenario(scenarioPath("maintain/" + name));
  scenario.seed = seed;
  return scenario;
}

WindowMeans meansOf(const DriveScenario& scenario, std::size_t imu) {
  WindowMeans means;
  for (const ImuSample& sample : simulateDriveImu(scenario, imu))
    means.add(secondsSince(scenario.start_ns, sample.time_ns), sample);
  means.finish();
  return means;
}

StopCalibration stopsOf(const DriveScenario& scenario, const MaintenanceOptions& options) {
  const WindowMeans means = meansOf(scenario);
  return calibrateFromStops(means.windows(), scenario.imus.front(), scenario.gravity_m_s2, options);
}

std::vector<PairWindow> pairWindows(const DriveScenario& scenario) {
  const MaintenanceOptions options;
  std::vector<ImuState> states(scenario.imus.begin(), scenario.imus.end());
  std::vector<PairNominal> nominal;
  for (const SimulatedImu& imu : scenario.imus) {
    nominal.emplace_back();
    nominal.back().reference_from_imu = imu.reference_from_imu;
    nominal.back().time_offset_s = imu.time_offset_s;
  }
  ImuPairs pairs(states, nominal, options.smoothing_s, options);
  const std::vector<ImuSample> first = simulateDriveImu(scenario, 0), second = simulateDriveImu(scenario, 1);
  for (std::size_t a = 0, b = 0; a < first.size() || b < second.size();) {
    const bool of_first = b >= second.size() || (a < first.size() && first[a].time_ns <= second[b].time_ns);
    const ImuSample& sample = of_first ? first[a++] : second[b++];
    pairs.add(of_first ? 0 : 1, secondsSince(scenario.start_ns, sample.time_ns), sample);
  }
  pairs.finish();
  return pairs.windows()[1];
}

PairModel pairModel(const DriveScenario& scenario) {
  PairModel model;
  model.gyroscope_walk = std::hypot(scenario.imus[0].gyroscope_walk, scenario.imus[1].gyroscope_walk);
  model.accelerometer_walk =
      std::hypot(scenario.imus[0].accelerometer_walk, scenario.imus[1].accelerometer_walk);
  model.lever_m = scenario.imus[1].reference_from_imu.translation_m;
  return model;
}

PairTrack trackOf(const DriveScenario& scenario, double alarm_probability) {
  return trackPair(pairWindows(scenario), pairModel(scenario), alarm_probability, MaintenanceOptions());
}

}  // namespace evical::test
