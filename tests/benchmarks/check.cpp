// `evical check` on pairs of simulated recordings of one rig, as a table: unchanged, with one change, and too
// poor for a verdict. `evical_benchmarks check [--pairs N] [--before S] [--after S] [--events] SCENARIO`. Of
// five pairs three are unchanged, one is changed, one is poor; each five share their first recording. Without
// --events, circles are those of an ideal front end. Fails if more than 3 % of all are false alarms, or if a
// change of detectable size is missed.
#include "core/base/error.h"
#include "core/frontend/board_tracker.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/assessment_report.h"
#include "core/report/report_options.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/support/scenario_session.h"
#include "tests/support/seen_through.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace evical::benchmarks::check {
namespace {

constexpr double kNoise_px = 0.05, kWindow_s = 0.02;
constexpr std::array<const char*, 4> kQuantities = {"rotation", "translation", "time_offset", "intrinsics"};
constexpr std::array<const char*, 3> kPoor = {"3 s", "hardly moved", "board half out of view"};

struct Change {
  std::string quantity;  // empty: none
  double size = 0.0;     // deg, mm, ms, px RMS
};

Eigen::Vector3d directionOf(int k) {
  return Eigen::Vector3d(1.0 + k % 3, -1.0 + 0.7 * (k % 5), 0.5 * (k % 4) - 1.0).normalized();
}

Change apply(int k, double factor, SimulatedCamera& camera) {
  constexpr std::array<double, 4> kSizes = {0.05, 1.0, 0.1, 0.2};
  const auto kind = static_cast<std::size_t>(k) % kSizes.size();
  const Change change{kQuantities[kind], factor * kSizes[kind]};
  RigidTransform& pose = camera.imu_from_camera;
  if (kind == 0)
    pose.rotation = Eigen::Quaterniond(so3Exp(Eigen::Vector3d(kRadPerDeg * change.size * directionOf(k)))) *
                    pose.rotation;
  if (kind == 1) pose.translation_m += 1e-3 * change.size * directionOf(k);
  if (kind == 2) camera.time_offset_s += 1e-3 * change.size;
  if (kind == 3) {
    // Displacement by a longer focal length: proportional to the distance from the image centre.
    const Eigen::Vector2d size(camera.intrinsics.resolution_px.width_px,
                               camera.intrinsics.resolution_px.height_px);
    const double mean_px = size.norm() / std::sqrt(12.0);
    camera.intrinsics.focal_length_px *= 1.0 + change.size / mean_px;
  }
  return change;
}

// Projection by the old result's lens.
DetectionResult passOf(const Scenario& scenario, const CameraIntrinsics& lens, bool from_events) {
  DetectionResult detections = test::perfectPass(scenario, kNoise_px, kWindow_s);
  if (from_events) {
    BoardTracker tracker(scenario.board, lens.resolution_px, lens, {}, scenario.start_ns);
    simulateEvents(scenario, 0, [&](EventSpan events) { tracker.add(events); });
    detections.cameras.front() = tracker.finish();
    detections.cameras.front().camera = scenario.cameras.front().name;
  } else {
    test::seeThrough(scenario.cameras.front().intrinsics, lens, detections.cameras.front());
  }
  detections.lenses.front() = givenLens(lens);
  return detections;
}

void makePoor(int kind, Scenario& scenario) {
  if (kind == 0) scenario.duration_s = 3.0;
  if (kind == 1) {
    scenario.motion.distance_amplitude_m *= 0.05;
    scenario.motion.angle_amplitude_rad *= 0.05;
    scenario.motion.target_amplitude_m *= 0.05;
    scenario.motion.image_speed_px_s *= 0.05;  // otherwise hand tremor is informative
  }
}

// Half of the board, and only for a part of the time.
void hideHalf(const Board& board, DetectionResult& detections) {
  for (BoardView& view : detections.cameras.front().views)
    std::erase_if(view.circles,
                  [&](const CircleObservation& circle) { return 2 * circle.circle < board.pointCount(); });
  std::erase_if(detections.cameras.front().views, [](const BoardView& view) { return view.time_s > 4.0; });
}

struct Row {
  int pair = 0;
  std::string kind;
  Change change;
  CalibrationCheck check;
};

struct Tally {
  int unchanged = 0, good = 0, false_alarms = 0, cannot_tell = 0;
  int changed = 0, found = 0, missed = 0, open = 0;  // missed: changes of detectable size
  int poor = 0, poor_open = 0, poor_good = 0, poor_alarms = 0;

  void add(const Row& row) {
    const Verdict verdict = row.check.verdict;
    if (row.kind == "unchanged") {
      ++unchanged;
      good += verdict == Verdict::Unchanged;
      false_alarms += verdict == Verdict::Changed;
      cannot_tell += verdict == Verdict::CannotTell;
    } else if (row.kind == "changed") {
      ++changed;
      found += verdict == Verdict::Changed;
      open += verdict == Verdict::CannotTell;
      missed += verdict != Verdict::Changed && claimed(row);
    } else {
      ++poor;
      poor_open += verdict == Verdict::CannotTell;
      poor_good += verdict == Verdict::Unchanged;
      poor_alarms += verdict == Verdict::Changed;
    }
  }
  static bool claimed(const Row& row) {
    return std::any_of(row.check.findings.begin(), row.check.findings.end(), [&](const Finding& q) {
      return q.quantity == row.change.quantity && q.smallest_detectable_change <= row.change.size;
    });
  }
  int all() const { return unchanged + changed + poor; }
  void print() const {
    fmt::print(
        "\nunchanged: {} called so, {} cannot tell, {} false alarms of {}\nchanged: {} found, {} cannot "
        "tell, {} "
        "missed that would have been noticed, of {}\npoor: {} cannot tell, {} unchanged, {} false alarms of "
        "{}\n",
        good, cannot_tell, false_alarms, unchanged, found, open, missed, changed, poor_open, poor_good,
        poor_alarms, poor);
  }
  bool isGood() const { return 100 * (false_alarms + poor_alarms) <= 3 * std::max(all(), 34) && missed == 0; }
};

std::string noticeText(const CalibrationCheck& check, const char* quantity) {
  for (const Finding& each : check.findings)
    if (each.quantity == quantity)
      return fmt::format("{:.3g} ({:.3g})", each.smallest_detectable_change, each.change);
  return "";
}

void print(const Row& row) {
  fmt::print(
      "| {} | {} | {} |", row.pair,
      row.change.quantity.empty() ? row.kind : fmt::format("{} {:.3g}", row.change.quantity, row.change.size),
      verdictWords(row.check.verdict));
  for (const char* quantity : kQuantities) fmt::print(" {} |", noticeText(row.check, quantity));
  fmt::print(" {} |\n", row.check.reason);
  std::fflush(stdout);
}

struct Arguments {
  std::string scenario;
  int pairs = 100, first = 0;
  double before_s = 30.0, after_s = 9.0, factor = 1.0;
  bool events = false;
  std::vector<std::string> settings;

  void addTo(Command& app) {
    app.option("SCENARIO", scenario, "Scenario file").required();
    app.option("--pairs", pairs, "Number of pairs");
    app.option("--first", first, "Index of the first pair");
    app.option("--before", before_s, "Seconds of the first recording of a pair");
    app.option("--after", after_s, "Seconds of the second recording of a pair");
    app.option("--factor", factor, "Size of changes, in units of 0.05 deg, 1 mm, 0.1 ms, 0.2 px");
    app.flag("--events", events, "Simulate events, too, instead of circles only");
    app.option("--set", settings, "group.option=value");
  }
};

NamedResult resultBefore(const Arguments& arguments, int five) {
  Scenario scenario = readScenario(arguments.scenario);
  scenario.duration_s = arguments.before_s;
  scenario.seed += static_cast<std::uint64_t>(five);
  Session session = test::sessionFor(scenario);
  session.options.report.edit().split_half_check = false;
  DetectionResult detections = passOf(scenario, scenario.cameras.front().intrinsics, arguments.events);
  const CalibrationRun run = calibrate(session, std::move(detections), {});
  return namedResult(session, std::make_shared<const CalibrationResult>(run.result), "benchmark");
}

Row checkPair(const Arguments& arguments, int pair, const NamedResult& before) {
  constexpr int kApart = 1000, kGroup = 5;
  Scenario scenario = readScenario(arguments.scenario);
  scenario.duration_s = arguments.after_s;
  scenario.seed += static_cast<std::uint64_t>(kApart + pair);
  Row row{pair, "unchanged", {}, {}};
  const int of_five = pair % kGroup, five = pair / kGroup, poor = five % static_cast<int>(kPoor.size());
  Session session = test::sessionFor(scenario);
  if (of_five == 3) {
    row.kind = "changed";
    row.change = apply(five, arguments.factor, scenario.cameras.front());
  }
  if (of_five == 4) {
    row.kind = kPoor[static_cast<std::size_t>(poor)];
    makePoor(poor, scenario);
  }
  for (const std::string& setting : arguments.settings) {
    const std::size_t equals = setting.find('=');
    setOption(session.options, setting.substr(0, equals), setting.substr(equals + 1));
  }
  const CheckInput input = checkInputOf(before, session);
  DetectionResult detections = passOf(scenario, *input.session.cameras.front().intrinsics, arguments.events);
  if (of_five == 4 && poor == 2) hideHalf(scenario.board, detections);
  row.check = checkCalibration(input, std::move(detections), {}).check;
  return row;
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("evical check on simulated pairs of recordings");
  Arguments arguments;
  arguments.addTo(app);
  if (!app.parse(argc, argv)) return 0;
  fmt::print(
      "would be noticed (change found):\n| pair | truth | verdict | rotation, deg | translation, mm | time "
      "offset, ms | "
      "lens, px | reason |\n|---|---|---|---|---|---|---|---|\n");
  Tally tally;
  std::map<int, NamedResult> before;
  for (int pair = arguments.first; pair < arguments.first + arguments.pairs; ++pair) {
    if (!before.contains(pair / 5)) before = {{pair / 5, resultBefore(arguments, pair / 5)}};
    const Row row = checkPair(arguments, pair, before.at(pair / 5));
    print(row);
    tally.add(row);
  }
  tally.print();
  return tally.isGood() ? 0 : 1;
}

}  // namespace evical::benchmarks::check
