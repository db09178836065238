// Shaky hands: splines follow the motion, and errors agree with the sigmas.
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/report_options.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

class TestShakyHands : public QObject {
  Q_OBJECT

 private slots:
  void shakyHands_haveHonestSigmas_data() {
    QTest::addColumn<int>("seed");
    QTest::addColumn<double>("rate_hz");
    QTest::addColumn<double>("largest_scale");
    for (const int seed : {1, 2, 3}) QTest::addRow("seed %d", seed) << seed << 1000.0 << 1.3;
    // The knot spacing cannot be so small: the weights account for the splines' error.
    for (const int seed : {1, 2, 3}) QTest::addRow("200 Hz, seed %d", seed) << seed << 200.0 << 20.0;
  }
  void shakyHands_haveHonestSigmas() {
    QFETCH(int, seed);
    QFETCH(double, rate_hz);
    QFETCH(double, largest_scale);
    Scenario scenario = readScenario(test::scenarioPath("shaky"));
    scenario.seed = static_cast<std::uint64_t>(seed);
    scenario.imus.front().rate_hz = rate_hz;
    Session session = test::sessionFor(scenario);
    session.options.report.edit().split_half_check = false;
    const CalibrationRun run = calibrate(session, test::perfectPass(scenario, 0.05, 0.015), RunContext{});
    const ImuData& imu = run.detections.imus.front();
    const double sigma_m_s2 = imu.noise.accelerometer_density * std::sqrt(imu.rate_hz());
    const double scale = run.result.imus.front().accelerometer_rms_m_s2 / sigma_m_s2;
    QVERIFY2(scale > 0.7 && scale < largest_scale, qPrintable(QString::number(scale)));
    verifySigmas(session, scenario, run);
  }

 private:
  static void verifySigmas(const Session& session, const Scenario& scenario, const CalibrationRun& run) {
    const TruthComparison comparison =
        compareWithTruth(namedResult(session, std::make_shared<CalibrationResult>(run.result), "test"),
                         test::truthOf(scenario));
    for (const QuantityDifference& quantity : comparison.quantities) {
      QVERIFY2(std::abs(quantity.normalised()) <= 3.5,
               qPrintable(QString("%1: error %2, sigma %3")
                              .arg(QString::fromStdString(quantity.name))
                              .arg(quantity.difference)
                              .arg(quantity.sigma)));
    }
    const double rms = comparison.normalisedRms();
    QVERIFY2(rms > 0.3 && rms < 1.6, qPrintable(QString::number(rms)));
  }
};

}  // namespace

EVICAL_TEST(TestShakyHands)
#include "tst_shaky_hands.moc"
