#include "tests/benchmarks/scenario_run.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/frontend/board_tracker.h"
#include "core/frontend/detection_options.h"
#include "core/geometry/camera_model.h"
#include "core/numerics/angles.h"
#include "core/pipeline/detection/camera_views.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/frame_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/session_errors.h"
#include "tests/support/scenario_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

namespace evical {
namespace {

// Runs the front end on the simulated events; its time is measured separately.
BoardObservations fromEvents(const Scenario& scenario, const Session& session, std::size_t k,
                             const CameraIntrinsics& camera, double& busy_s) {
  BoardTracker tracker(session.boardOf(k), camera.resolution_px, camera, *session.options.front_end,
                       scenario.start_ns);
  simulateEvents(scenario, k, [&](EventSpan events) {
    const Stopwatch stopwatch;
    tracker.add(events);
    busy_s += stopwatch.elapsed_s();
  });
  const Stopwatch stopwatch;
  BoardObservations found = tracker.finish();
  busy_s += stopwatch.elapsed_s();
  return found;
}

// The same for frames.
BoardObservations fromFrames(const Scenario& scenario, const Session& session, std::size_t k,
                             const CameraIntrinsics& camera, double& busy_s) {
  const RunContext context;
  const CameraLens lens = givenLens(camera);
  CameraBatch batch;
  batch.camera = k;
  batch.kind = CameraKind::Frames;
  batch.opened_px = camera.resolution_px;
  batch.start_ns = scenario.start_ns;
  const std::unique_ptr<CameraViews> views = cameraViews(batch, {session, lens, context});
  simulateFrames(scenario, k, [&](const Frame& frame) {
    const Stopwatch stopwatch;
    batch.frames = {frame};
    views->consume(batch);
    busy_s += stopwatch.elapsed_s();
  });
  const Stopwatch stopwatch;
  std::vector<RecordingFault> faults;
  BoardObservations found = views->finish(faults);
  busy_s += stopwatch.elapsed_s();
  return found;
}

DetectionResult detect(const Scenario& scenario, const Session& session, Outcome& outcome) {
  DetectionResult detections;
  detections.start_ns = scenario.start_ns;
  double busy_s = 0.0;
  std::uint64_t events_read = 0;
  const Scenario said = asSessionSays(scenario);
  for (std::size_t k = 0; k < scenario.cameras.size(); ++k) {
    const CameraIntrinsics& camera = said.cameras[k].intrinsics;
    const auto find = scenario.cameras[k].frames ? fromFrames : fromEvents;
    detections.cameras.push_back(find(scenario, session, k, camera, busy_s));
    detections.lenses.push_back(givenLens(camera));
    detections.cameras.back().camera = scenario.cameras[k].name;
    events_read += detections.cameras.back().events;
  }
  for (std::size_t k = 0; k < scenario.imus.size(); ++k) {
    const SimulatedImu& imu = said.imus[k];
    detections.imus.push_back(
        {imu.name, {imu.gyroscope_density, imu.accelerometer_density}, simulateImu(scenario, k)});
  }
  detections.detect_s = outcome.detect_s = busy_s;
  outcome.events_per_s = static_cast<double>(events_read) / scenario.duration_s;
  return detections;
}

double windowsFound(const Scenario& scenario, const BoardObservations& observations) {
  const SinusoidMotion motion(scenario);
  int seen = 0, found = 0;
  for (const WindowReport& window : observations.windows) {
    if (!boardInView(motion, scenario, 0, window.time_s)) continue;
    ++seen;
    found += window.outcome == WindowOutcome::Complete || window.outcome == WindowOutcome::Partial;
  }
  return seen == 0 ? 0.0 : static_cast<double>(found) / seen;
}

PartError partError(const TruthComparison& comparison, const char* part) {
  std::map<std::string, std::array<double, 2>> squares;  // of error and sigma, by sensor
  PartError worst;
  for (const QuantityDifference& quantity : comparison.quantities) {
    if (!isOf(part, quantity)) continue;
    auto& [error2, sigma2] = squares[quantity.name.substr(0, quantity.name.find(part))];
    error2 += quantity.difference * quantity.difference;
    sigma2 += quantity.sigma * quantity.sigma;
    worst.sigmas = std::max(worst.sigmas, std::abs(quantity.normalised()));
  }
  for (const auto& [sensor, square] : squares) {
    worst.size = std::max(worst.size, std::sqrt(square[0]));
    worst.sigma = std::max(worst.sigma, std::sqrt(square[1]));
  }
  return worst;
}

}  // namespace

DetectionResult detectScenario(const Scenario& scenario) {
  Outcome ignored;
  return detect(scenario, test::sessionFor(scenario), ignored);
}

Outcome runScenario(const Scenario& scenario, const SessionChange& change) {
  Session session = test::sessionFor(scenario);
  if (change) change(session);
  Outcome detected;
  DetectionResult detections = detect(scenario, session, detected);
  Outcome outcome = calibrateScenario(scenario, std::move(detections), change);
  outcome.detect_s = detected.detect_s;
  outcome.events_per_s = detected.events_per_s;
  return outcome;
}

Outcome calibrateScenario(const Scenario& scenario, DetectionResult detections, const SessionChange& change) {
  Session session = test::sessionFor(scenario);
  if (change) change(session);
  return calibrateSession(scenario, session, std::move(detections));
}

Outcome calibrateSession(const Scenario& scenario, const Session& session, DetectionResult detections) {
  Outcome outcome;
  outcome.windows_found = windowsFound(scenario, detections.cameras.front());
  const Stopwatch stopwatch;
  try {
    const CalibrationRun run = calibrate(session, std::move(detections), RunContext{});
    outcome.verdict = statusName(run.result.status);
    outcome.weakest = run.result.uncertainty.weakest;
    outcome.reason = run.result.reason;
    outcome.comparison =
        compareWithTruth(namedResult(session, std::make_shared<CalibrationResult>(run.result), "benchmark"),
                         test::truthOf(scenario));
    for (const CameraUncertainty& camera : run.result.uncertainty.cameras) {
      CameraUncertainty& worst = outcome.uncertainty ? *outcome.uncertainty : outcome.uncertainty.emplace();
      if (camera.translation_std_m.norm() > worst.translation_std_m.norm()) worst = camera;
    }
    outcome.result = run.result;
  } catch (const CalibrationError& error) {
    outcome.verdict = statusName(CalibrationStatus::Failed);
    outcome.reason = error.what();
  }
  outcome.solve_s = stopwatch.elapsed_s();
  return outcome;
}

NormalisedErrors::NormalisedErrors(std::span<const Outcome> outcomes) : recordings(outcomes.size()) {
  for (const Outcome& outcome : outcomes) {
    if (!outcome.comparison) continue;
    for (const QuantityDifference& quantity : outcome.comparison->quantities) {
      if (quantity.sigma <= 0.0) continue;
      const auto add = [&](const char* part, Sum& sum) {
        if (quantity.name.find(part) == std::string::npos) return;
        sum.squares += quantity.normalised() * quantity.normalised();
        ++sum.count;
      };
      add("", all);
      add(".rotation.", rotation);
      add(".translation.", translation);
      add(".time_offset", time_offset);
    }
  }
}

bool NormalisedErrors::areRight() const {
  constexpr std::size_t kEnoughRecordings = 20;
  const auto isRight = [](const Sum& sum) { return sum.rms() >= 0.7 && sum.rms() <= 1.4; };
  return recordings < kEnoughRecordings ||
         (isRight(rotation) && isRight(translation) && isRight(time_offset) && isRight(all));
}

bool NormalisedErrors::print() const {
  fmt::print(
      "\nnormalised errors over {} recordings, RMS: rotation {:.2f}, translation {:.2f}, time offset {:.2f}, "
      "all quantities {:.2f} (target 0.7-1.4)\n",
      recordings, rotation.rms(), translation.rms(), time_offset.rms(), all.rms());
  return areRight();
}

bool isOf(const char* part, const QuantityDifference& number) {
  return number.name.find(part) != std::string::npos && number.name.find("drift") == std::string::npos;
}

void subtractPixelDelay(double delay_s, Outcome& outcome) {
  if (!outcome.comparison) return;
  const double delay_ms = 1e3 * delay_s;
  for (QuantityDifference& number : outcome.comparison->quantities)
    if (isOf(".time_offset", number)) {
      number.difference += delay_ms;
      outcome.comparison->cameras.front().time_offset_ms = std::abs(number.difference);
    }
}

PartError rotationError_deg(const TruthComparison& comparison) {
  return partError(comparison, ".rotation.");
}
PartError translationError_mm(const TruthComparison& comparison) {
  return partError(comparison, ".translation.");
}
PartError timeOffsetError_ms(const TruthComparison& comparison) {
  return partError(comparison, ".time_offset");
}

bool isWrong(const Outcome& outcome) {
  const auto exceeds = [](const PartError& error, double bound) {
    return error.size > bound && error.sigmas > kWrongSigmas;
  };
  return outcome.comparison && (exceeds(rotationError_deg(*outcome.comparison), kWrongRotation_deg) ||
                                exceeds(translationError_mm(*outcome.comparison), kWrongTranslation_mm) ||
                                exceeds(timeOffsetError_ms(*outcome.comparison), kWrongTimeOffset_ms));
}

bool isWrongOk(const Outcome& outcome) {
  return outcome.verdict == "ok" && isWrong(outcome);
}

void printQuantities(const Outcome& outcome) {
  if (!outcome.comparison) return;
  fmt::print("{}weakest: {}\nreason: {}\n", comparisonTable(*outcome.comparison), outcome.weakest,
             outcome.reason);
}

CalibrationState trueState(const Scenario& scenario) {
  return test::truthOf(scenario).result->state;
}

double shareOfImageCircle(const CameraIntrinsics& camera) {
  constexpr double kFurthest_rad = 95.0 * kRadPerDeg;
  const Eigen::Vector3d ray(std::sin(kFurthest_rad), 0.0, std::cos(kFurthest_rad));
  const auto border = project(camera, ray);
  const Eigen::Vector2d size(camera.resolution_px.width_px - 1, camera.resolution_px.height_px - 1);
  const Eigen::Vector2d& centre = camera.principal_point_px;
  const double corner_px = centre.cwiseMax(size - centre).norm();
  return border ? (*border - centre).norm() / corner_px : 1.0;
}

}  // namespace evical
