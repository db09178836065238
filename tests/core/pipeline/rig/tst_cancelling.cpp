// A calibration stops soon after a request, in any stage. Latencies are measured in the process's own
// computing time, which other programs on the machine do not change.
#include "core/base/progress.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/processor_time.h"
#include "tests/support/scenario_session.h"
#include "tests/support/simulated_recording.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace {

using namespace evical;

class StageRecorder final : public ProgressSink {
 public:
  void stageStarted(const ProgressStage& stage) override {
    const std::scoped_lock lock(mutex_);
    stage_ = stage.name;
  }
  void stageProgress(double) override {}
  void log(LogLevel, std::string_view) override {}
  std::string stage() const {
    const std::scoped_lock lock(mutex_);
    return stage_;
  }

 private:
  mutable std::mutex mutex_;
  std::string stage_;
};

using Work = std::function<void(const RunContext&)>;

struct Stop {
  bool cancelled = false;
  double latency_s = 0.0;
  std::string stage;
};

// Requests a stop after `after_s` of computing time.
Stop stopAfter(const Work& work, double after_s) {
  Stop result;
  StageRecorder recorder;
  std::stop_source source;
  std::atomic<bool> done = false;
  const double begin_s = test::processCpu_s();
  std::jthread worker([&] {
    try {
      work(RunContext{recorder, source.get_token()});
    } catch (const Cancelled&) {
      result.cancelled = true;
    }
    done = true;
  });
  while (!done && test::processCpu_s() - begin_s < after_s)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  result.stage = recorder.stage();
  const double asked_s = test::processCpu_s();
  source.request_stop();
  worker.join();
  result.latency_s = test::processCpu_s() - asked_s;
  return result;
}

// The minimum of a few runs: the first is slower, and so are runs concurrent with other programs.
double wholeTime_s(const Work& work) {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 3; ++run) {
    const double begin_s = test::processCpu_s();
    work(RunContext{});
    shortest_s = std::min(shortest_s, test::processCpu_s() - begin_s);
  }
  return shortest_s;
}

// At many points of the work; returns the stages in which it was stopped.
QStringList stopEverywhere(const Work& work) {
  constexpr double kLongest_s = 0.5;
  double whole_s = wholeTime_s(work);
  QStringList stages;
  for (const double part : {0.01, 0.04, 0.1, 0.25, 0.4, 0.6, 0.75, 0.85, 0.92, 0.97}) {
    Stop stop = stopAfter(work, part * whole_s);
    if (!stop.cancelled) {  // it was finished before: other programs, which slowed the measured runs, have
                            // ended
      whole_s = std::min(whole_s, wholeTime_s(work));
      stop = stopAfter(work, part * whole_s);
    }
    if (!stop.cancelled) continue;
    stages << QString::fromStdString(stop.stage);
    qInfo("stopped after %.2f of %.2f s in %s: %.3f s", part * whole_s, whole_s, stop.stage.c_str(),
          stop.latency_s);
    if (stop.latency_s > kLongest_s) stages << "LATE";
  }
  return stages;
}

Scenario everyday(double duration_s) {
  Scenario scenario = readScenario(test::scenarioPath("davis346"));
  scenario.duration_s = duration_s;
  return scenario;
}

class TestCancelling : public QObject {
  Q_OBJECT

 private slots:
  void solving_stopsSoon() {
    const Scenario scenario = everyday(qEnvironmentVariableIntValue("EVICAL_CANCEL_S") > 0
                                           ? qEnvironmentVariableIntValue("EVICAL_CANCEL_S")
                                           : 10.0);
    Session session = test::sessionFor(scenario);
    session.options.optimisation.edit().threads = 1;
    const DetectionResult detections = test::perfectPass(scenario, 0.05, 0.02);
    const QStringList stages =
        stopEverywhere([&](const RunContext& context) { calibrate(session, detections, context); });
    QVERIFY(!stages.contains("LATE"));
    QVERIFY(stages.contains("optimise"));
    QVERIFY(stages.size() >= 8);
  }

  // Rotation about one axis makes initialisation search for the angle about it.
  void initialising_stopsSoon() {
    Scenario scenario = readScenario(test::scenarioPath("one_axis_rotation"));
    scenario.duration_s = 10.0;
    const Session session = test::sessionFor(scenario);
    const DetectionResult detections = test::perfectPass(scenario, 0.05, 0.02);
    const Work whole = [&](const RunContext& context) { calibrate(session, detections, context); };
    int in_initialisation = 0;
    for (const double after_s : {0.02, 0.05, 0.1, 0.2, 0.3}) {
      const Stop stop = stopAfter(whole, after_s);
      QVERIFY(stop.cancelled);
      QVERIFY2(stop.latency_s <= 0.5, qPrintable(QString::number(stop.latency_s)));
      in_initialisation += stop.stage == "initialise";
    }
    QVERIFY(in_initialisation > 0);
  }

  void detecting_stopsSoon() {
    const Session session = readSession(test::simulatedRecording("davis346", 4.0));
    const QStringList stages =
        stopEverywhere([&](const RunContext& context) { readAndDetect(session, context); });
    QVERIFY(!stages.contains("LATE"));
    QVERIFY(stages.size() >= 4);
  }
};

}  // namespace

EVICAL_TEST(TestCancelling)
#include "tst_cancelling.moc"
