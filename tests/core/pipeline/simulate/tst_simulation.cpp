// A scenario as a folder: recording, session and truth, which fit each other.
#include "core/base/error.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/report/result_yaml.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <stop_token>

using namespace evical;

class TestSimulation : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    scenario_ = readScenario(test::scenarioPath("davis346_10s"));
    scenario_.duration_s = 0.5;
  }

  void recording_holdsWhatIsReported() {
    const QTemporaryDir folder;
    const SimulationSummary summary = simulate(scenario_, folder.path().toStdString(), {});
    const Session session = readSession(summary.session);
    const DetectionResult detections = readAndDetect(session, {});
    QCOMPARE(detections.cameras.front().events, summary.events);
    QCOMPARE(static_cast<std::uint64_t>(detections.imus.front().samples.size()), summary.imu_samples);
    QCOMPARE(detections.start_ns / 1'000'000'000, scenario_.start_ns / 1'000'000'000);
    const NamedResult truth = readResultYaml(summary.truth);
    QVERIFY(truth.result->state.cameras.front().reference_from_camera.translation_m.isApprox(
        scenario_.cameras.front().imu_from_camera.translation_m));
  }

  void sameSeed_givesTheSameEvents() {
    const QTemporaryDir one, other;
    QCOMPARE(simulate(scenario_, one.path().toStdString(), {}).events,
             simulate(scenario_, other.path().toStdString(), {}).events);
    Scenario changed = scenario_;
    ++changed.seed;
    QVERIFY(simulate(changed, other.path().toStdString(), {}).events !=
            simulate(scenario_, one.path().toStdString(), {}).events);
  }

  // Session and truth come last: an incomplete recording has neither.
  void cancelled_leavesNoSession() {
    const QTemporaryDir folder;
    std::stop_source stop;
    stop.request_stop();
    QVERIFY_THROWS_EXCEPTION(
        Cancelled, simulate(scenario_, folder.path().toStdString(), {silentProgress(), stop.get_token()}));
    QVERIFY(!QFile::exists(folder.filePath("session.yaml")) && !QFile::exists(folder.filePath("truth.yaml")));
  }

  void unknownFormat_isRefused() {
    const QTemporaryDir folder;
    QVERIFY_THROWS_EXCEPTION(CalibrationError,
                             simulate(scenario_, folder.path().toStdString(), {}, "punch cards"));
  }

 private:
  Scenario scenario_;
};

EVICAL_TEST(TestSimulation)
#include "tst_simulation.moc"
