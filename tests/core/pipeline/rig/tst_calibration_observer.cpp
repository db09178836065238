#include "core/data/calibration_observer.h"

#include "core/pipeline/rig/calibration_pipeline.h"
#include "tests/support/simulated_recording.h"
#include "tests/support/test_program.h"

using namespace evical;

namespace {

class Notebook final : public CalibrationObserver {
 public:
  void windowsDetected(std::size_t camera, const BoardObservations& so_far) override {
    QCOMPARE(camera, std::size_t{0});
    QVERIFY(so_far.windows.size() > windows);
    windows = so_far.windows.size();
    ++window_calls;
  }
  void detectionDone(const CalibrationInput& given) override {
    QVERIFY(steps.isEmpty() && iterations.empty());
    input = given;
  }
  void initialisationStepDone(std::string_view step, std::string_view subject, std::string_view result,
                              double duration_s) override {
    QVERIFY(iterations.empty());
    QVERIFY(!result.empty() && !result.starts_with(std::string(subject) + ":"));
    QVERIFY(duration_s >= 0.0 && duration_s < 60.0);
    duration_of_steps_s += duration_s;
    steps << QString::fromUtf8(step.data(), static_cast<qsizetype>(step.size()));
  }
  void iterationDone(const IterationRecord& iteration, const CalibrationState& now) override {
    iterations.push_back(iteration);
    state = now;
  }

  std::size_t windows = 0;
  int window_calls = 0;
  CalibrationInput input;
  QStringList steps;
  double duration_of_steps_s = 0.0;
  std::vector<IterationRecord> iterations;
  CalibrationState state;
};

}  // namespace

class TestCalibrationObserver : public QObject {
  Q_OBJECT

 private slots:
  void observer_hearsOfEveryStageInOrder() {
    const Session session = readSession(test::simulatedRecording("davis346", 4.0));
    Notebook notebook;
    const CalibrationRun run = calibrate(session, {silentProgress(), {}, &notebook});

    QVERIFY(notebook.window_calls > 5);
    QVERIFY(notebook.windows + 3 >=
            run.detections.cameras[0].windows.size());  // the last ones arrive at the end
    QCOMPARE(notebook.input.imus.at(0).samples.size(), run.detections.imus.at(0).samples.size());
    QVERIFY(notebook.duration_of_steps_s > 0.0);
    QVERIFY(notebook.duration_of_steps_s < 1.05 * run.result.timing.initialise_s + 0.01);
    QCOMPARE(notebook.steps,
             (QStringList{"camera poses", "planar poses", "time offset", "camera-IMU rotation",
                          "knot spacing", "gravity and translation", "board scale"}));
    QCOMPARE(notebook.iterations.size(), run.result.iterations.size());
    QCOMPARE(notebook.iterations.back().cost, run.result.iterations.back().cost);
    QCOMPARE(notebook.state.cameras.at(0).time_offset_s, run.result.state.cameras.at(0).time_offset_s);
    QCOMPARE(notebook.state.imu_in_world_m.segmentCount(), run.result.state.imu_in_world_m.segmentCount());
  }
};

EVICAL_TEST(TestCalibrationObserver)
#include "tst_calibration_observer.moc"
