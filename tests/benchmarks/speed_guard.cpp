// Guards against stages that become slower: `evical_benchmarks speed_guard BASELINE [--renew]`. Each stage's
// CPU time is divided by that of a fixed amount of work (speed_reference.cpp) in the same run, so that
// machines are comparable. The minimum over several rounds counts, each with two runs of a stage. The
// benchmark fails if a ratio exceeds the baseline's by more than the stage's tolerance. Against the baseline
// of another processor model a stage fails if it takes twice as long. `--renew` writes the ratios of this run
// as the new baseline, `--table FILE` writes the printed table.
#include "core/base/atomic_file.h"
#include "core/base/child_process.h"
#include "core/base/time.h"
#include "core/base/yaml_node.h"
#include "core/frontend/board_search.h"
#include "core/frontend/board_tracker.h"
#include "core/frontend/detection_options.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/initialise.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/rig/split_half_check.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/recording/recording_reader.h"
#include "core/report/report_options.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/support/processor_time.h"
#include "tests/support/real_recordings.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_folders.h"

#include <fmt/format.h>

#include <QTemporaryDir>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace evical::benchmarks::speed_guard {
namespace {

constexpr double kEvents_s = 2.0;       // of recording with events
constexpr double kBatch_s = 8.0;        // of recording for all that comes after detection
constexpr double kLarge_s = 0.5;        // of recording of a sensor of 1280 x 720 pixels
constexpr double kShort_s = 5.0;        // of recording for a whole run of the program
constexpr double kCorners_s = 20.0;     // of EuRoC's recording
constexpr std::size_t kReferences = 5;  // per round: the minimum of many is the machine's speed
constexpr std::size_t kRepeats = 2;     // of a stage per round: the first run fetches its input from memory
constexpr double kMayGrow = 0.3;        // if the baseline does not state it
constexpr double kMayDiffer = 1.0;      // from another processor's
constexpr std::size_t kBatch = 50'000;

// First processor according to Linux: name and numbers of the model, caches; empty if unknown.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string text;
  for (std::string line; std::getline(info, line) && !line.empty();)
    for (const char* const key : {"model name", "cpu family", "model\t", "cache size"})
      if (line.starts_with(key)) text += (text.empty() ? "" : ", ") + line.substr(line.find(':') + 2);
  return text;
}

// Input of a tracker for each batch of events.
struct BurstBatch {
  std::vector<EdgeCrossing> bursts;
  std::int64_t first_event_ns, complete_until_ns;
};

// Events of a scenario and the first two stages of their detection.
class EventStages {
 public:
  EventStages(Scenario scenario, double duration_s, const RunContext& context)
      : scenario_(std::move(scenario)), camera_(scenario_.cameras.front().intrinsics) {
    scenario_.duration_s = duration_s;
    recording_ = simulate(scenario_, folder_.path().toStdString(), context).recording;
    read([&](const Packet& packet) {
      events_.insert(events_.end(), packet.events.begin(), packet.events.end());
    });
  }

  // Keeps no events: a copy of all of them would measure the machine's memory instead of the reader.
  void read() {
    read([](const Packet&) {});
  }

  void bursts() {
    batches_.clear();
    BurstExtractor extractor(camera_.resolution_px, options().bursts);
    for (std::size_t k = 0; k < events_.size(); k += kBatch) {
      const EventSpan batch(events_.data() + k, std::min(kBatch, events_.size() - k));
      BurstBatch& out = batches_.emplace_back();
      extractor.add(batch, out.bursts);
      out.first_event_ns = batch.front().time_ns;
      out.complete_until_ns = extractor.completeUntil_ns();
    }
    extractor.finish(batches_.emplace_back().bursts);
    batches_.back().complete_until_ns = extractor.completeUntil_ns();
  }

  void windows() {
    BoardTracker tracker(scenario_.board, camera_.resolution_px, camera_, options(), scenario_.start_ns);
    for (std::size_t k = 0; k + 1 < batches_.size(); ++k)
      tracker.addBursts(batches_[k].bursts, batches_[k].first_event_ns, batches_[k].complete_until_ns);
    if (tracker.finish().views.empty())
      throw calibrationFailed("windows", "show no board", "See the front end's tests");
  }

  void search() {
    const BoardScene scene(scenario_.board, camera_.resolution_px, camera_);
    BurstHistory history;
    for (const BurstBatch& batch : batches_) history.add(batch.bursts);
    for (const double part : {0.3, 0.5, 0.7})
      searchBoard(history, events_.front().time_ns + nanosecondsFrom(part * scenario_.duration_s), scene,
                  options());
  }

 private:
  const FrontEndOptions& options() const { return *session_.options.front_end; }

  template <typename Use>
  void read(const Use& use) {
    const auto reader = openRecording(recording_);
    const StreamType events = StreamType::Events;
    reader->select({findStream(*reader, scenario_.cameras.front().stream, events)});
    Packet packet;
    while (reader->read(packet)) use(packet);
  }

  QTemporaryDir folder_;
  Scenario scenario_;
  CameraIntrinsics camera_;
  Session session_;  // default options
  std::filesystem::path recording_;
  std::vector<Event> events_;
  std::vector<BurstBatch> batches_;
};

// The stages, in order: each uses the results of those before it.
class Stages {
 public:
  explicit Stages(const Scenario& scenario)
      : events_(scenario, kEvents_s, context_),
        large_(readScenario(test::scenarioPath("hd")), kLarge_s, context_),
        lens_(test::simulatePass(kBatch_s, "intrinsics_fisheye")) {
    test::SimulatedPass simulated = test::simulatePass(kBatch_s, scenario);
    session_ = simulated.session;
    // One thread: waiting for another does not count as work.
    session_.options.optimisation.edit().threads = 1;
    start_ = initialiseCalibration(session_, std::move(simulated.detections), context_);
    Scenario of_run = scenario;
    of_run.duration_s = kShort_s;
    short_ = simulate(of_run, folder_.filePath("short").toStdString(), context_).session;
    if (const QString real = test::realRecordings(); !real.isEmpty()) {
      corners_ = test::eurocImuApril(real, QDir(folder_.path()));
      corners_->time_range_s = {0.0, kCorners_s};
      corners_->options.optimisation.edit().threads = 1;
    }
  }

  bool hasCorners() const { return corners_.has_value(); }

  void reference() { speedReference(); }
  void read() { events_.read(); }
  void bursts() { events_.bursts(); }
  void windows() { events_.windows(); }
  void search() { events_.search(); }
  void largeBursts() { large_.bursts(); }
  void largeWindows() { large_.windows(); }

  void initialisation() { initialise(start_.input, *session_.options.initialisation, context_); }
  void batch() {
    solution_ = optimiseBatch(start_.input, start_.initial.state, *session_.options.optimisation, context_);
  }
  void uncertainty() {
    estimateUncertainty(start_.input, solution_, *session_.options.optimisation, context_);
  }
  void halves() {
    checkHalves(start_.input, solution_.state, *session_.options.optimisation,
                session_.options.report->split_half_check_block_s, context_);
  }
  void lens() {
    estimateIntrinsics({lens_.session.board,
                        lens_.detections.resolutions_px.front(),
                        lens_.detections.cameras.front(),
                        lens_.truth.cameras.front().intrinsics,
                        {}},
                       *lens_.session.options.intrinsics, context_);
  }

  // A calibration of frames and IMU, from measured corners of tags.
  void corners() { static_cast<void>(calibrate(*corners_, context_)); }

  // The program with all that it reads and writes.
  void shortRun() {
    const std::string output = folder_.filePath("result").toStdString();
    std::filesystem::remove_all(output);
    const ProcessEnd end =
        ChildProcess({{EVICAL_PROGRAM, "calibrate", short_.string(), "-o", output, "--quiet"},
                      folder_.filePath("log").toStdString()})
            .wait();
    if (end.exit_code < 0 || !std::filesystem::exists(output))
      throw calibrationFailed("short run", "wrote no result", "Run it in a shell");
  }

 private:
  QTemporaryDir folder_;
  RunContext context_;
  EventStages events_, large_;
  Session session_;
  InitialisedCalibration start_;
  BatchSolution solution_;
  test::SimulatedPass lens_;
  std::filesystem::path short_;
  std::optional<Session> corners_;
};

struct Stage {
  const char* name;
  void (Stages::*work)();
  double min_s = std::numeric_limits<double>::infinity();
  double baseline = 0.0, may_grow = kMayGrow;
  std::optional<double> allowed = {};  // for this stage, instead of the default

  double ratio(double reference_s) const { return min_s / reference_s; }
  double mayGrow() const { return allowed.value_or(may_grow); }
  bool grown(double reference_s) const {
    return baseline > 0.0 && ratio(reference_s) > (1.0 + mayGrow()) * baseline;
  }
};

class Guard {
 public:
  explicit Guard(const std::string& scenario) : stages_of_(readScenario(scenario)) {
    if (stages_of_.hasCorners()) return;
    fmt::print("EVICAL_DATA is not set: the stage corners is left out.\n");
    std::erase_if(stages_, [](const Stage& stage) { return stage.work == &Stages::corners; });
  }

  // A file that is renewed may lack new stages.
  void readBaseline(const std::string& file, bool renew) {
    const YamlNode root = YamlNode::load(file);
    const YamlNode ratios = root["ratios"];
    const bool same = root["processor"].text() == processor();
    std::vector<std::string> known = {"corners"};
    for (const Stage& stage : stages_) known.emplace_back(stage.name);
    ratios.allowOnly(known);
    for (Stage& stage : stages_) {
      if (renew && !ratios.find(stage.name)) continue;
      const YamlNode row = ratios[stage.name];
      row.allowOnly({"ratio", "may_grow"});
      stage.baseline = row["ratio"].real();
      if (const auto may_grow = row.find("may_grow")) stage.may_grow = may_grow->real();
      if (!same) stage.allowed = std::max(stage.may_grow, kMayDiffer);
    }
  }

  void round() {
    ++rounds_;
    for (std::size_t k = 0; k < kReferences; ++k) measure(&Stages::reference, reference_s_);
    for (Stage& stage : stages_)
      for (std::size_t k = 0; k < kRepeats; ++k) measure(stage.work, stage.min_s);
  }

  bool anyGrown() const {
    return std::any_of(stages_.begin(), stages_.end(),
                       [&](const Stage& stage) { return stage.grown(reference_s_); });
  }

  std::string table() const {
    std::string text =
        fmt::format("CPU time over that of the reference work ({:.1f} ms), minimum of {} rounds\n\n",
                    1e3 * reference_s_, rounds_);
    text += "| stage | ms | ratio | baseline | change |\n|---|---|---|---|---|\n";
    for (const Stage& stage : stages_)
      text +=
          fmt::format("| {} | {:.1f} | {:.2f} | {:.2f} | {:+.0f} %{} |\n", stage.name, 1e3 * stage.min_s,
                      stage.ratio(reference_s_), stage.baseline,
                      stage.baseline > 0.0 ? 100.0 * (stage.ratio(reference_s_) / stage.baseline - 1.0) : 0.0,
                      stage.grown(reference_s_)
                          ? fmt::format(", more than the tolerance of {:.0f} %", 100.0 * stage.mayGrow())
                          : "");
    return text;
  }

  std::string baseline() const {
    std::string text =
        "# CPU time of each stage over that of tests/benchmarks/speed_reference.cpp, the baseline of "
        "evical_benchmarks speed_guard.\n"
        "# A stage may grow by 0.3, or by its may_grow if its own scatter on a busy machine is wider. To "
        "renew, on a\n"
        "# quiet machine: build/ci/tests/benchmarks/evical_benchmarks speed_guard "
        "tests/benchmarks/speed_baseline.yaml --renew\n"
        "processor: " +
        yamlText(processor()) + "\nratios:\n";
    for (const Stage& stage : stages_) {
      text += fmt::format("  {}: {{ratio: {:.3g}", stage.name, stage.ratio(reference_s_));
      if (stage.may_grow != kMayGrow) text += fmt::format(", may_grow: {}", stage.may_grow);
      text += "}\n";
    }
    return text;
  }

 private:
  void measure(void (Stages::*work)(), double& min_s) {
    const auto now_s = [] { return test::processCpu_s() + test::childrenCpu_s(); };
    const double begin_s = now_s();
    (stages_of_.*work)();
    min_s = std::min(min_s, now_s() - begin_s);
  }

  Stages stages_of_;
  std::vector<Stage> stages_ = {{"read", &Stages::read},
                                {"bursts", &Stages::bursts},
                                {"windows", &Stages::windows},
                                {"search", &Stages::search},
                                {"initialise", &Stages::initialisation},
                                {"batch", &Stages::batch},
                                {"uncertainty", &Stages::uncertainty},
                                {"halves", &Stages::halves},
                                {"lens", &Stages::lens},
                                {"hd_bursts", &Stages::largeBursts},
                                {"hd_windows", &Stages::largeWindows},
                                {"corners", &Stages::corners},
                                {"short_run", &Stages::shortRun}};
  double reference_s_ = std::numeric_limits<double>::infinity();
  int rounds_ = 0;
};

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Guards against stages that become slower");
  std::string baseline, table, scenario = test::scenarioPath("davis346");
  int rounds = 3, max_rounds = 9;
  bool renew = false;
  app.option("BASELINE", baseline, "File of ratios").required();
  app.flag("--renew", renew, "Write the ratios of this run as the new baseline");
  app.option("--table", table, "File for the printed table");
  app.option("--scenario", scenario, "Scenario to simulate");
  app.option("--rounds", rounds, "Minimum number of rounds").between(1, 100);
  app.option("--most-rounds", max_rounds,
             "Maximum number of rounds if a stage seems slower, since other programs may disturb it")
      .between(1, 100);
  if (!app.parse(argc, argv)) return 0;
  Guard guard(scenario);
  if (std::filesystem::exists(baseline) || !renew) guard.readBaseline(baseline, renew);
  for (int k = 0; k < (renew ? max_rounds : rounds); ++k) guard.round();
  for (int k = rounds; k < max_rounds && !renew && guard.anyGrown(); ++k) guard.round();
  fmt::print("{}", guard.table());
  if (!table.empty()) writeFileWhole(table, guard.table());
  if (renew) {
    writeFileWhole(baseline, guard.baseline());
    return 0;
  }
  if (!guard.anyGrown()) return 0;
  fmt::print(
      "\nA stage has become slower. Profile it ('evical calibrate --profile', perf); where that is the price "
      "of something "
      "worth it, renew the baseline: 'evical_benchmarks speed_guard {} --renew'\n",
      baseline);
  return 1;
}

}  // namespace evical::benchmarks::speed_guard
