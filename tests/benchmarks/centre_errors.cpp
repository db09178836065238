// Measured circle centres against the truth of simulated recordings, along the motion: `evical_benchmarks
// centre_errors
// [--seeds N] [--duration S] [--speeds] [--variant OPTION=VALUE,...]... SCENARIO...`. A recording is
// simulated once, in memory; the front end runs over it with each variant of its options. Error model of a
// centre: -d v + l e + q a + g (centre - its mean), for a delay d, an edge localisation bias l, an
// acceleration error q, and a motion amplitude that is measured g too large; docs/maths.md, 9.1 defines e.
// The batch estimates delay and lead, but takes q and g for motion. An acceleration error of a sinusoid
// scales its amplitude by q w^2, so that q and g describe the same fault: each is fitted without the other.
#include "core/base/option_table.h"
#include "core/base/time.h"
#include "core/frontend/board_tracker.h"
#include "core/synthetic/event_simulator.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/benchmarks/centre_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace evical::benchmarks::centre_errors {
namespace {

double rmsOf(const std::vector<CentreError>& errors, const ErrorFit& fit) {
  double squares = 0.0;
  for (const CentreError& error : errors)
    squares +=
        (error.error_px + fit.delay_s * error.velocity_px_s - fit.lead_px * error.lead_effect).squaredNorm();
  return errors.empty() ? 0.0 : std::sqrt(squares / (2.0 * static_cast<double>(errors.size())));
}

// Error of centres due to q in this recording: an upper bound of q's part in the RMS error next to it.
double accelerationPart_px(const std::vector<CentreError>& errors, double q_s2) {
  double squares = 0.0;
  for (const CentreError& error : errors) squares += error.acceleration_px_s2.squaredNorm();
  return errors.empty() ? 0.0
                        : std::abs(q_s2) * std::sqrt(squares / (2.0 * static_cast<double>(errors.size())));
}

// Lag of centres along their motion, by speed, separately for decelerating and accelerating image motion.
void printSpeeds(const std::vector<CentreError>& errors) {
  constexpr std::array kLimits_px_s = {0.0, 10.0, 20.0, 35.0, 60.0, 120.0, 1e9};
  fmt::print(
      "\n| px/s | circles | lag while decelerating, px | lag while accelerating, px "
      "|\n|---|---|---|---|\n");
  for (std::size_t k = 0; k + 1 < kLimits_px_s.size(); ++k) {
    std::array<double, 2> sums = {0.0, 0.0};
    std::array<int, 2> counts = {0, 0};
    for (const CentreError& error : errors) {
      if (error.speed_px_s < kLimits_px_s[k] || error.speed_px_s >= kLimits_px_s[k + 1]) continue;
      const Eigen::Vector2d along = error.velocity_px_s.normalized();
      const std::size_t speeding = along.dot(error.acceleration_px_s2) > 0.0 ? 1 : 0;
      sums[speeding] -= along.dot(error.error_px);
      ++counts[speeding];
    }
    const auto mean = [&](std::size_t i) { return counts[i] == 0 ? 0.0 : sums[i] / counts[i]; };
    if (counts[0] + counts[1] == 0) continue;
    fmt::print("| from {:.0f} | {} | {:.3f} | {:.3f} |\n", kLimits_px_s[k], counts[0] + counts[1], mean(0),
               mean(1));
  }
  fmt::print("\n");
}

// Sets an option of the groups that measurements depend on.
void setOption(const std::string& group, const std::string& name, const std::string& value,
               FrontEndOptions& options) {
  if (group == "bursts") return BurstOptions::table().set(options.bursts, group, name, value);
  if (group == "detection") return DetectionOptions::table().set(options.detection, group, name, value);
  if (group == "tracking") return TrackingOptions::table().set(options.tracking, group, name, value);
  throw badInput("--variant " + group, "no such group", "Groups are bursts, detection and tracking");
}

FrontEndOptions optionsOf(const std::string& variant) {
  FrontEndOptions options;
  forEachSetting(variant, [&](const std::string& full_name, const std::string& value) {
    const std::size_t dot = full_name.find('.');
    if (dot == std::string::npos)
      throw badInput("--variant " + variant, "is not a setting",
                     "Write group.option=value,group.option=value");
    setOption(full_name.substr(0, dot), full_name.substr(dot + 1), value, options);
  });
  return options;
}

struct Tables {
  bool speeds = false, agreement = false;
};

void printHeader() {
  fmt::print(
      "| scenario | seed | options | windows | circles | delay, ms | lead, px | q, ms^2 | of it in px, RMS | "
      "gain, 1e-3 | RMS, px | errors over sigmas | front end, s "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void runVariant(const Scenario& scenario, const std::vector<Event>& events, const std::string& variant,
                const Tables& tables) {
  constexpr std::size_t kBatch = 50'000;
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  BoardTracker tracker(scenario.board, camera.resolution_px, camera, optionsOf(variant), scenario.start_ns);
  const Stopwatch stopwatch;
  for (std::size_t k = 0; k < events.size(); k += kBatch)
    tracker.add(EventSpan(events.data() + k, std::min(kBatch, events.size() - k)));
  const BoardObservations observations = tracker.finish();
  const double spent_s = stopwatch.elapsed_s();
  const std::vector<CentreError> errors = errorsOf(scenario, observations);
  const ErrorFit by_acceleration =
      fitErrors(errors, [](const CentreError& error) { return error.acceleration_px_s2; });
  const ErrorFit by_gain = fitErrors(errors, [](const CentreError& error) { return error.from_mean_px; });
  fmt::print(
      "| {} | {} | {} | {} of {} | {} | {:.3f} | {:.3f} | {:.1f} | {:.4f} | {:.2f} | {:.4f} | {:.2f} | "
      "{:.1f} |\n",
      scenario.name, scenario.seed, variant.empty() ? "default" : variant, observations.views.size(),
      observations.windows.size(), errors.size(), 1e3 * by_acceleration.delay_s, by_acceleration.lead_px,
      1e6 * by_acceleration.third, accelerationPart_px(errors, by_acceleration.third), 1e3 * by_gain.third,
      rmsOf(errors, by_acceleration), by_acceleration.chi, spent_s);
  if (tables.speeds) printSpeeds(errors);
  if (tables.agreement) {
    ErrorAgreement agreement;
    agreement.add(errors, by_acceleration);
    agreement.print();
  }
  std::fflush(stdout);
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Errors of circle centres along the motion, on simulated recordings");
  ScenarioArguments scenarios;
  std::vector<std::string> variants;
  Tables tables;
  scenarios.addTo(app);
  app.option("--variant", variants, "Options of a further run: group.option=value,...").repeated();
  app.flag("--speeds", tables.speeds, "Also the lag of centres by speed");
  app.flag("--agreement", tables.agreement,
           "Also how errors of circles of one window agree, by speed and distance");
  if (!app.parse(argc, argv)) return 0;
  variants.insert(variants.begin(), std::string());
  printHeader();
  for (const std::string& file : scenarios.files) {
    for (int k = 0; k < scenarios.seeds; ++k) {
      const Scenario scenario = scenarios.read(file, k);
      std::vector<Event> events;
      simulateEvents(scenario, 0,
                     [&](EventSpan packet) { events.insert(events.end(), packet.begin(), packet.end()); });
      for (const std::string& variant : variants) runVariant(scenario, events, variant, tables);
    }
  }
  return 0;
}

}  // namespace evical::benchmarks::centre_errors
