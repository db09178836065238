// Costs of the hot paths on a simulated recording, as a table: `evical_benchmarks speed [--duration S]
// SCENARIO`. CPU time of one thread, so that other work on the machine has little effect; compare ratios
// between builds, not machines. costs.cpp has the costs of whole runs.
#include "core/frontend/board_search.h"
#include "core/frontend/board_tracker.h"
#include "core/initialisation/initialise.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "tests/benchmarks/benchmark_program.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace evical::benchmarks::speed {
namespace {

constexpr std::size_t kBatch = 50'000;

// Events to bursts, and bursts to windows, measured separately.
BoardObservations detect(const Scenario& scenario, const std::vector<Event>& events) {
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  const FrontEndOptions options;
  BurstExtractor extractor(camera.resolution_px, options.bursts);
  BoardTracker tracker(scenario.board, camera.resolution_px, camera, options, scenario.start_ns);
  double extracting_s = 0.0, tracking_s = 0.0;
  std::size_t burst_count = 0;
  std::vector<EdgeCrossing> bursts;
  for (std::size_t k = 0; k < events.size(); k += kBatch) {
    const EventSpan batch(events.data() + k, std::min(kBatch, events.size() - k));
    double begin = test::threadCpu_s();
    bursts.clear();
    extractor.add(batch, bursts);
    extracting_s += test::threadCpu_s() - begin;
    burst_count += bursts.size();
    begin = test::threadCpu_s();
    tracker.addBursts(bursts, batch.front().time_ns, extractor.completeUntil_ns());
    tracking_s += test::threadCpu_s() - begin;
  }
  BoardObservations observations = tracker.finish();
  const auto n = static_cast<double>(events.size()),
             windows = static_cast<double>(observations.windows.size());
  fmt::print("| events to bursts | {:.1f} ns per event ({:.1f} Mev/s) | {} events, {} bursts |\n",
             1e9 * extracting_s / n, 1e-6 * n / extracting_s, events.size(), burst_count);
  fmt::print(
      "| bursts to board | {:.2f} ms per window, {:.1f} ns per event | {} windows, searches included |\n",
      1e3 * tracking_s / windows, 1e9 * tracking_s / n, observations.windows.size());
  return observations;
}

// Full searches in the middle of the recording, with either source of candidates.
void search(const Scenario& scenario, const std::vector<Event>& events) {
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  FrontEndOptions options;
  options.detection.try_both = false;
  const BoardScene scene(scenario.board, camera.resolution_px, camera);
  BurstExtractor extractor(camera.resolution_px, options.bursts);
  std::vector<EdgeCrossing> bursts;
  extractor.add(events, bursts);
  extractor.finish(bursts);
  BurstHistory history;
  history.add(bursts);
  for (const CandidateSource source : {CandidateSource::NormalFlow, CandidateSource::RingVote}) {
    options.detection.method = source;
    constexpr int kSearches = 20;
    int found = 0;
    const double begin = test::threadCpu_s();
    for (int k = 0; k < kSearches; ++k) {
      const std::int64_t span_ns = events.back().time_ns - events.front().time_ns;
      const std::int64_t middle_ns = events.front().time_ns + span_ns * (k + 2) / (kSearches + 4);
      found += searchBoard(history, middle_ns, scene, options).back().motion.has_value();
    }
    fmt::print("| search, {} | {:.1f} ms | board found in {} of {} |\n",
               source == CandidateSource::NormalFlow ? "normal_flow" : "ring_vote",
               1e3 * (test::threadCpu_s() - begin) / kSearches, found, kSearches);
  }
}

void optimise(const Scenario& scenario, BoardObservations observations) {
  const SimulatedCamera& camera = scenario.cameras.front();
  const SimulatedImu& imu = scenario.imus.front();
  CalibrationInput input;
  input.start_ns = scenario.start_ns;
  input.board = scenario.board;
  input.cameras.push_back({camera.name, givenLens(camera.intrinsics), std::move(observations)});
  input.imus.push_back(
      {imu.name, {imu.gyroscope_density, imu.accelerometer_density}, simulateImu(scenario, 0)});
  double begin = test::processCpu_s();
  const Initialisation initial = initialise(input, InitialisationOptions{}, RunContext{});
  fmt::print("| initialisation | {:.0f} ms | {:.0f} s of recording |\n", 1e3 * (test::processCpu_s() - begin),
             scenario.duration_s);
  begin = test::processCpu_s();
  const BatchSolution solution = optimiseBatch(input, initial.state, OptimisationOptions{}, RunContext{});
  const double spent_s = test::processCpu_s() - begin;
  fmt::print(
      "| batch | {:.0f} ms per iteration, {:.2f} s in total | {} iterations, {} circles, {} IMU samples |\n",
      1e3 * spent_s / static_cast<double>(solution.iterations.size()), spent_s, solution.iterations.size(),
      solution.cameras.front().circles_used, input.imus.front().samples.size());
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Costs of the hot paths, in CPU time");
  std::string file;
  double duration_s = 10.0;
  app.option("SCENARIO", file, "Scenario file").required();
  app.option("--duration", duration_s, "Duration of the recording, s").between(2.0, 60.0);
  if (!app.parse(argc, argv)) return 0;
  Scenario scenario = readScenario(file);
  scenario.duration_s = duration_s;
  std::vector<Event> events;
  simulateEvents(scenario, 0,
                 [&](EventSpan packet) { events.insert(events.end(), packet.begin(), packet.end()); });
  fmt::print("| {} | cost | of |\n|---|---|---|\n", scenario.name);
  BoardObservations observations = detect(scenario, events);
  search(scenario, events);
  events.clear();
  optimise(scenario, std::move(observations));
  return 0;
}

}  // namespace evical::benchmarks::speed
