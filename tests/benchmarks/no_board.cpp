// Checks of an old, true calibration in rooms without a board: errors of rotation and time offset, their
// sigmas and the verdicts, over seeds. Fails if a target is missed.
#include "core/base/in_parallel.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/check/check_without_board.h"
#include "core/report/assessment_report.h"
#include "core/synthetic/imu_simulator.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/support/processor_time.h"
#include "tests/support/scenario_session.h"
#include "tests/support/simulated_record.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <utility>
#include <vector>

namespace evical::benchmarks::no_board {
namespace {

// Statistics of one kind of quantity over all runs.
struct Spread {
  double squares = 0.0, weighed = 0.0, worst = 0.0, largest = 0.0, sigmas = 0.0;
  int count = 0;

  void add(double error, double sigma) {
    squares += error * error;
    weighed += error * error / (sigma * sigma);
    worst = std::max(worst, std::abs(error) / sigma);
    largest = std::max(largest, std::abs(error));
    sigmas += sigma * sigma;
    ++count;
  }
  double rms() const { return std::sqrt(squares / std::max(1, count)); }
  double rmsSigma() const { return std::sqrt(sigmas / std::max(1, count)); }
  double ratio() const { return std::sqrt(weighed / std::max(1, count)); }
};

struct Seen {
  BoardlessPass pass;
  double own_s = 0.0;  // processor time without the simulation
};

Seen see(const Scenario& scenario, const CalibrationOptions& options) {
  test::SimulatedRecord camera = test::simulatedRecord(scenario, options);
  Seen seen;
  seen.own_s = camera.processor_s;
  seen.pass.start_ns = scenario.start_ns;
  seen.pass.cameras.push_back(std::move(camera.record));
  seen.pass.kinds.push_back(CameraKind::Events);
  for (std::size_t k = 0; k < scenario.imus.size(); ++k)
    seen.pass.imus.push_back({scenario.imus[k].name, {}, simulateImu(scenario, k)});
  return seen;
}

// Rotations about the IMU's axes, like their sigmas.
void addErrors(const Finding& quantity, Spread& turns, Spread& delays) {
  const std::vector<ComparedNumber>& numbers = quantity.numbers;
  if (quantity.quantity != "rotation") {
    for (const ComparedNumber& number : numbers)
      delays.add(number.now.value - number.before.value, number.now.sigma);
    return;
  }
  Eigen::Vector3d before_deg, now_deg;
  for (int k = 0; k < 3; ++k) {
    before_deg[k] = numbers.at(static_cast<std::size_t>(k)).before.value;
    now_deg[k] = numbers.at(static_cast<std::size_t>(k)).now.value;
  }
  const Eigen::Vector3d error_rad =
      so3Log(so3Exp(kRadPerDeg * now_deg) * so3Exp(kRadPerDeg * before_deg).transpose());
  for (int k = 0; k < 3; ++k)
    turns.add(error_rad[k] / kRadPerDeg, numbers.at(static_cast<std::size_t>(k)).now.sigma);
}

struct Outcome {
  CalibrationCheck check;
  double own_s = 0.0, duration_s = 0.0;
};

// In one thread, so that the thread's time is the total.
Outcome checked(const Scenario& scenario) {
  CheckInput input = checkInputOf(test::truthOf(scenario), test::sessionFor(scenario));
  input.session.options.optimisation.edit().threads = 1;
  Seen seen = see(scenario, input.session.options);
  const double before_s = test::threadCpu_s();
  Outcome outcome{checkWithoutBoard(input, std::move(seen.pass)).check, 0.0, scenario.duration_s};
  outcome.own_s = seen.own_s + test::threadCpu_s() - before_s;
  return outcome;
}

class Table {
 public:
  void run(const std::string& file, const ScenarioArguments& arguments, int jobs) {
    std::vector<Outcome> outcomes(static_cast<std::size_t>(arguments.seeds));
    std::mutex saying;
    inParallel(jobs, outcomes.size(), [&](std::size_t k) {
      const Scenario scenario = arguments.read(file, static_cast<int>(k));
      outcomes[k] = checked(scenario);
      const CalibrationCheck& check = outcomes[k].check;
      const std::lock_guard lock(saying);
      fmt::print("{} {:.0f} s, seed {}: {}\n{}", scenario.name, scenario.duration_s, scenario.seed,
                 check.windows.empty() ? "" : windowsText(check.windows.front()), assessmentTable(check));
      std::fflush(stdout);
    });
    Spread turns, delays, told_turns, told_delays;
    std::array<int, 3> verdicts = {};
    double own_s = 0.0, duration_s = 0.0;
    for (const Outcome& outcome : outcomes) {
      own_s += outcome.own_s;
      duration_s += outcome.duration_s;
      ++verdicts.at(static_cast<std::size_t>(outcome.check.verdict));
      for (const Finding& quantity : outcome.check.findings) {
        addErrors(quantity, turns, delays);
        if (outcome.check.verdict != Verdict::CannotTell) addErrors(quantity, told_turns, told_delays);
      }
    }
    rows_ += fmt::format(
        "{:<16}{:>6}{:>8.0f}{:>10.3f}{:>10.3f}{:>8.2f}{:>8.1f}{:>10.3f}{:>10.3f}{:>8.2f}{:>8.1f}   {:>2} / "
        "{:>2} / {:>2}"
        "{:>10.2f}\n",
        std::filesystem::path(file).stem().string(), arguments.seeds, duration_s / arguments.seeds,
        turns.rms(), turns.rmsSigma(), turns.ratio(), turns.worst, delays.rms(), delays.rmsSigma(),
        delays.ratio(), delays.worst, verdicts[0], verdicts[1], verdicts[2], own_s / duration_s);
    const std::string name = std::filesystem::path(file).stem().string();
    if (name == "room_near")
      judgeNearWalls(name, told_turns);
    else
      judge(name, {turns, delays, told_turns}, verdicts[1], own_s / duration_s, arguments.seeds);
  }
  int missed() const { return missed_; }
  void print() const {
    fmt::print(
        "\n{:<16}{:>6}{:>8}{:>36}{:>36}\n{:<16}{:>6}{:>8}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>15}{:"
        ">10}\n{}",
        "", "", "", "rotation [deg]", "time offset [ms]", "room", "seeds", "s", "error", "sigma", "ratio",
        "worst", "error", "sigma", "ratio", "worst", "good/chg/?", "time", rows_);
    fmt::print(
        "error and sigma: RMS over numbers and seeds; ratio: of error over sigma; worst: the largest of "
        "those;\n"
        "time: of one core, over the recording's duration\n\n{}",
        targets_);
  }

 private:
  struct Errors {
    const Spread &turns, &delays, &told_turns;
  };
  void target(const std::string& name, const std::string& what, double figure, double most,
              double least = 0.0) {
    const bool reached = figure >= least && figure <= most;
    missed_ += reached ? 0 : 1;
    targets_ += fmt::format("{:<16}{:<44}{:>8.3f}   {:>4.1f} to {:<6.1f}{}\n", name, what, figure, least,
                            most, reached ? "ok" : "MISSED");
  }
  void judge(const std::string& name, const Errors& errors, int changed, double time, int seeds) {
    constexpr int kEnough = 20;  // for ratios
    target(name, "rotation, RMS [deg]", errors.turns.rms(), 0.2);
    target(name, "time offset, RMS [ms]", errors.delays.rms(), 0.5);
    target(name, "called changed", changed, 0.0);
    target(name, "rotation with a verdict, worst [sigma]", errors.told_turns.worst, 4.0);
    if (name == "room") target(name, "one core's time over the recording's", time, 2.0);
    if (seeds < kEnough) return;
    target(name, "rotation, errors over sigmas", errors.turns.ratio(), 1.4, 0.7);
    target(name, "time offset, errors over sigmas", errors.delays.ratio(), 1.4, 0.7);
  }
  void judgeNearWalls(const std::string& name, const Spread& told_turns) {
    target(name, "rotation with a verdict, worst [deg]", told_turns.largest, 0.4);
    target(name, "rotation with a verdict, worst [sigma]", told_turns.worst, 4.0);
  }

  std::string rows_, targets_;
  int missed_ = 0;
};

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Old calibrations checked without a board");
  ScenarioArguments arguments;
  int jobs = 2;
  arguments.addTo(app);
  app.option("--jobs", jobs, "Number of seeds at a time").between(1, 64);
  if (!app.parse(argc, argv)) return 0;
  Table table;
  for (const std::string& file : arguments.files) table.run(file, arguments, jobs);
  table.print();
  return table.missed() == 0 ? 0 : 1;
}

}  // namespace evical::benchmarks::no_board
