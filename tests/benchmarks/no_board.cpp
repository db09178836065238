// An old calibration, the truth, checked by rooms without a board: errors of rotation and time offset, their sigmas and the
// verdicts, over seeds.
#include "core/egomotion/window_motion.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/camera_motion.h"
#include "core/pipeline/check_without_board.h"
#include "core/report/check_report.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/support/scenario_session.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>

namespace evical {
namespace {

double processorTime_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// Of one kind of number, over all runs.
struct Spread {
  double squares = 0.0, weighed = 0.0, worst = 0.0, sigmas = 0.0;
  int count = 0;

  void add(double error, double sigma) {
    squares += error * error;
    weighed += error * error / (sigma * sigma);
    worst = std::max(worst, std::abs(error) / sigma);
    sigmas += sigma * sigma;
    ++count;
  }
  double rms() const { return std::sqrt(squares / std::max(1, count)); }
  double rmsSigma() const { return std::sqrt(sigmas / std::max(1, count)); }
  double ratio() const { return std::sqrt(weighed / std::max(1, count)); }
};

struct Seen {
  BoardlessPass pass;
  double own_s = 0.0;  // processor time that is not the simulation's
};

Seen see(const Scenario& scenario, const CalibrationOptions& options) {
  Seen seen;
  const SimulatedCamera& camera = scenario.cameras.front();
  CameraMotion motion(camera.intrinsics, options, scenario.start_ns);
  BurstExtractor bursts(camera.intrinsics.resolution_px, options.front_end.bursts);
  std::vector<EdgeBurst> found;
  simulateEvents(
      scenario, 0,
      [&](EventSpan events) {
        const double before_s = processorTime_s();
        found.clear();
        bursts.add(events, found);
        motion.add(found, bursts.completeUntil_ns());
        seen.own_s += processorTime_s() - before_s;
      },
      {}, 1);
  const double before_s = processorTime_s();
  found.clear();
  bursts.finish(found);
  motion.add(found, bursts.completeUntil_ns());
  seen.pass.start_ns = scenario.start_ns;
  seen.pass.cameras.push_back(motion.finish());
  seen.pass.kinds.push_back(CameraKind::Events);
  seen.own_s += processorTime_s() - before_s;
  for (std::size_t k = 0; k < scenario.imus.size(); ++k)
    seen.pass.imus.push_back({scenario.imus[k].name, {}, simulateImu(scenario, k)});
  return seen;
}

// Rotations: about the IMU's axes, as sigmas are.
void addErrors(const CheckedQuantity& quantity, Spread& turns, Spread& delays) {
  const std::vector<CheckedNumber>& numbers = quantity.numbers;
  if (quantity.name != "rotation") {
    for (const CheckedNumber& number : numbers) delays.add(number.now - number.before, number.now_sigma);
    return;
  }
  Eigen::Vector3d before_deg, now_deg;
  for (int k = 0; k < 3; ++k) {
    before_deg[k] = numbers.at(static_cast<std::size_t>(k)).before;
    now_deg[k] = numbers.at(static_cast<std::size_t>(k)).now;
  }
  const Eigen::Vector3d error_rad =
      so3Log(so3Exp(kRadPerDeg * now_deg) * so3Exp(kRadPerDeg * before_deg).transpose());
  for (int k = 0; k < 3; ++k)
    turns.add(error_rad[k] / kRadPerDeg, numbers.at(static_cast<std::size_t>(k)).now_sigma);
}

class Table {
 public:
  void run(const std::string& file, const ScenarioArguments& arguments) {
    Spread turns, delays;
    std::array<int, 3> verdicts = {};
    double own_s = 0.0, duration_s = 0.0;
    for (int seed = 0; seed < arguments.seeds; ++seed) {
      const Scenario scenario = arguments.read(file, seed);
      const CheckInput input = checkInputOf(test::truthOf(scenario), test::sessionFor(scenario));
      Seen seen = see(scenario, input.session.options);
      const double before_s = processorTime_s();
      const CalibrationCheck check = checkWithoutBoard(input, std::move(seen.pass)).check;
      own_s += seen.own_s + processorTime_s() - before_s;
      duration_s += scenario.duration_s;
      ++verdicts.at(static_cast<std::size_t>(check.verdict));
      for (const CheckedQuantity& quantity : check.quantities) addErrors(quantity, turns, delays);
      fmt::print("{} {:.0f} s, seed {}: {}\n{}", scenario.name, scenario.duration_s, scenario.seed,
                 check.windows.empty() ? "" : windowsText(check.windows.front()), checkTable(check));
      std::fflush(stdout);
    }
    rows_ += fmt::format(
        "{:<16}{:>6}{:>8.0f}{:>10.3f}{:>10.3f}{:>8.2f}{:>8.1f}{:>10.3f}{:>10.3f}{:>8.2f}{:>8.1f}   {:>2} / "
        "{:>2} / {:>2}"
        "{:>10.2f}\n",
        std::filesystem::path(file).stem().string(), arguments.seeds, duration_s / arguments.seeds,
        turns.rms(), turns.rmsSigma(), turns.ratio(), turns.worst, delays.rms(), delays.rmsSigma(),
        delays.ratio(), delays.worst, verdicts[0], verdicts[1], verdicts[2], own_s / duration_s);
  }
  void print() const {
    fmt::print(
        "\n{:<16}{:>6}{:>8}{:>36}{:>36}\n{:<16}{:>6}{:>8}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>15}{:"
        ">10}\n{}",
        "", "", "", "rotation [deg]", "time offset [ms]", "room", "seeds", "s", "error", "sigma", "ratio",
        "worst", "error", "sigma", "ratio", "worst", "good/chg/?", "time", rows_);
    fmt::print(
        "error and sigma: RMS over numbers and seeds; ratio: of error over sigma; worst: the largest of "
        "those;\n"
        "time: one core's beside the recording's\n");
  }

 private:
  std::string rows_;
};

int main(int argc, char** argv) {
  CLI::App app("Old calibrations checked without a board");
  ScenarioArguments arguments;
  arguments.addTo(app);
  CLI11_PARSE(app, argc, argv);
  Table table;
  for (const std::string& file : arguments.files) table.run(file, arguments);
  table.print();
  return 0;
}

}  // namespace
}  // namespace evical

int main(int argc, char** argv) {
  return evical::guarded(evical::main, argc, argv);
}
