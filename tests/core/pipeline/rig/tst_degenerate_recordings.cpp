// Recordings whose motion leaves a quantity undetermined: the result must report and name it, and must not
// overstate its accuracy.
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <cmath>

namespace {

using namespace evical;

class TestDegenerateRecordings : public QObject {
  Q_OBJECT

 private slots:
  void sigmas_coverTheErrors_data() {
    QTest::addColumn<QString>("scenario");
    QTest::addColumn<bool>("events");
    QTest::addColumn<QString>("weakest");
    const char* const kAlongY = "translation along the camera's y axis";
    const char* const kAlongZ = "translation along the camera's z axis";
    QTest::newRow("one axis") << "one_axis_rotation" << true << kAlongY;
    QTest::newRow("one axis, perfect circles") << "one_axis_rotation" << false << kAlongY;
    QTest::newRow("planar") << "planar_motion" << true << kAlongZ;
    QTest::newRow("planar, perfect circles") << "planar_motion" << false << kAlongZ;
    QTest::newRow("hardly moving") << "hardly_moving" << true << "";
    QTest::newRow("hardly moving, perfect circles") << "hardly_moving" << false << "";
  }
  void sigmas_coverTheErrors() {
    QFETCH(QString, scenario);
    QFETCH(bool, events);
    QFETCH(QString, weakest);
    Scenario simulated = readScenario(test::scenarioPath(scenario.toStdString()));
    simulated.duration_s = 10.0;
    const Session session = test::sessionFor(simulated);
    const CalibrationRun run = calibrate(
        session, events ? test::detectedPass(simulated, session) : test::perfectPass(simulated, 0.05, 0.015),
        RunContext{});
    QCOMPARE(run.result.status, CalibrationStatus::Doubtful);
    QVERIFY(QString::fromStdString(run.result.reason).contains("Record again"));
    const QString named = QString::fromStdString(run.result.uncertainty.weakest);
    QVERIFY2(!named.isEmpty() && named.contains(weakest), qPrintable(named));
    const TruthComparison comparison =
        compareWithTruth(namedResult(session, std::make_shared<CalibrationResult>(run.result), "test"),
                         test::truthOf(simulated));
    for (const QuantityDifference& quantity : comparison.quantities) {
      QVERIFY2(std::abs(quantity.normalised()) <= 4.0,
               qPrintable(QString("%1: error %2, sigma %3")
                              .arg(QString::fromStdString(quantity.name))
                              .arg(quantity.difference)
                              .arg(quantity.sigma)));
    }
  }
};

}  // namespace

EVICAL_TEST(TestDegenerateRecordings)
#include "tst_degenerate_recordings.moc"
