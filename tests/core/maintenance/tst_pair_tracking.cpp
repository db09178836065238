// Two IMUs over time: relative quantities with correct sigmas, steps with their time and quantity, and no
// alarm without a change.
#include "tests/core/maintenance/drive_data.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

class TestPairTracking : public QObject {
  Q_OBJECT

 private slots:
  void start_isTheTruthWithinSigmas() {
    constexpr int kSeeds = 20;
    PairVector squares = PairVector::Zero();
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const PairTrack track = trackOf(driveScenario("none", static_cast<std::uint64_t>(seed)));
      squares += (track.start.array().square() / track.start_covariance.diagonal().array()).matrix();
    }
    const double ratio = std::sqrt(squares.head<7>().mean() / kSeeds);  // biases walk in addition
    QVERIFY2(ratio > 0.7 && ratio < 1.4, qPrintable(QString::number(ratio)));
  }

  // If the accelerometer was late in the calibration, too, nothing has changed.
  void lateAccelerometer_isTheTruthWithinSigmas_data() {
    QTest::addColumn<double>("reference_s");
    QTest::addColumn<double>("other_s");
    QTest::newRow("of the other") << 0.0 << 0.004;
    QTest::newRow("of the reference") << 0.006 << 0.0;
    QTest::newRow("of both, early") << -0.003 << 0.003;
  }
  void lateAccelerometer_isTheTruthWithinSigmas() {
    QFETCH(const double, reference_s);
    QFETCH(const double, other_s);
    constexpr int kSeeds = 10;
    PairVector squares = PairVector::Zero();
    for (int seed = 1; seed <= kSeeds; ++seed) {
      DriveScenario scenario = driveScenario("none", static_cast<std::uint64_t>(seed));
      scenario.imus[0].accelerometer_delay_s = reference_s;
      scenario.imus[1].accelerometer_delay_s = other_s;
      const PairTrack track = trackOf(scenario);
      QVERIFY(track.steps.empty());
      squares += (track.start.array().square() / track.start_covariance.diagonal().array()).matrix();
    }
    const double ratio = std::sqrt(squares.head<7>().mean() / kSeeds);
    QVERIFY2(ratio > 0.6 && ratio < 1.5, qPrintable(QString::number(ratio)));
  }

  void steps_areNamedInTime_data() {
    QTest::addColumn<int>("block");
    QTest::addColumn<double>("size");
    QTest::newRow("step_rotation") << 0 << 0.5 * 0.017453;
    QTest::newRow("step_lever") << 1 << 0.005;
    QTest::newRow("step_bias") << 4 << 0.1962;
  }
  void steps_areNamedInTime() {
    QFETCH(const int, block);
    QFETCH(const double, size);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const DriveScenario scenario = driveScenario(QTest::currentDataTag(), seed);
      const double at_s = scenario.steps.front().at_s;
      const PairTrack track = trackOf(scenario);
      QCOMPARE(track.steps.size(), std::size_t{1});
      const PairStep& step = track.steps.front();
      QCOMPARE(static_cast<int>(step.block), block);
      QVERIFY2(std::abs(step.at_s - at_s) <= 2.0, qPrintable(QString::number(step.at_s)));
      QVERIFY2(step.noticed_s - at_s <= 10.0, qPrintable(QString::number(step.noticed_s)));
      QVERIFY2(std::abs(step.change.step.norm() - size) < 0.15 * size,
               qPrintable(QString::number(step.change.step.norm())));
      // Afterwards it follows the new value.
      const PairVector last = track.values.back();
      QVERIFY(std::abs(last.segment(kPairBlocks[step.block].first, kPairBlocks[step.block].size).norm() -
                       size) < 0.05 * size);
    }
  }

  void timeOffset_step_isNamed() {
    DriveScenario scenario = driveScenario("none");
    ImuStep step;
    step.imu = 1;
    step.at_s = 50.0;
    step.time_offset_s = 0.002;
    scenario.steps = {step};
    const PairTrack track = trackOf(scenario);
    QCOMPARE(track.steps.size(), std::size_t{1});
    QCOMPARE(track.steps.front().block, std::size_t{2});
    QVERIFY(std::abs(track.steps.front().change.step[0] - 0.002) < 2e-4);
  }

  void twoStepsAtOnce_areBothNamed() {
    DriveScenario scenario = driveScenario("none");
    ImuStep step;
    step.imu = 1;
    step.at_s = 70.0;
    step.rotation_rad = {0.02, 0.0, 0.0};
    step.translation_m = {0.0, 0.03, 0.0};
    scenario.steps = {step};
    const PairTrack track = trackOf(scenario);
    std::vector<std::size_t> blocks;
    for (const PairStep& each : track.steps) blocks.push_back(each.block);
    QVERIFY(std::find(blocks.begin(), blocks.end(), 0) != blocks.end());
    QVERIFY(std::find(blocks.begin(), blocks.end(), 1) != blocks.end());
  }

  void nothing_givesNoAlarm() {
    for (std::uint64_t seed = 101; seed <= 125; ++seed)
      QVERIFY(trackOf(driveScenario("none", seed), 0.01).steps.empty());
  }

  // Mounts that vibrate or bend for a tenth of a second or for several: no alarm above the stated rate, and
  // correct sigmas.
  void shaking_isNoChange_data() {
    QTest::addColumn<double>("rate_rad_s");
    QTest::addColumn<double>("force_m_s2");
    QTest::addColumn<double>("correlation_s");
    QTest::newRow("a tenth of a second") << 0.005 << 0.1 << 0.1;
    QTest::newRow("a third") << 0.005 << 0.1 << 0.3;
    QTest::newRow("a second") << 0.003 << 0.05 << 1.0;
    QTest::newRow("two seconds") << 0.002 << 0.03 << 2.0;
    QTest::newRow("forces alone") << 0.0 << 0.1 << 0.3;
  }
  void shaking_isNoChange() {
    QFETCH(const double, rate_rad_s);
    QFETCH(const double, force_m_s2);
    QFETCH(const double, correlation_s);
    constexpr int kSeeds = 20;
    PairVector squares = PairVector::Zero();
    int alarms = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      DriveScenario scenario = driveScenario("none", static_cast<std::uint64_t>(200 + seed));
      for (SimulatedImu& imu : scenario.imus) imu.shake = {rate_rad_s, force_m_s2, correlation_s};
      const PairTrack track = trackOf(scenario, 0.005);
      alarms += track.steps.empty() ? 0 : 1;
      squares += (track.start.array().square() / track.start_covariance.diagonal().array()).matrix();
    }
    QVERIFY2(alarms == 0, qPrintable(QString::number(alarms)));
    const double ratio = std::sqrt(squares.mean() / kSeeds);
    QVERIFY2(ratio > 0.5 && ratio < 1.4, qPrintable(QString::number(ratio)));
  }

  void standing_tellsNoLeverArm() {
    DriveScenario scenario = driveScenario("none");
    scenario.motion.stops = 1;
    scenario.motion.stop_s = 1000.0;
    const PairTrack track = trackOf(scenario, 0.01);
    QVERIFY(track.steps.empty());
    QVERIFY(std::sqrt(track.start_covariance(3, 3)) > 0.1);
    QVERIFY(std::sqrt(track.start_covariance(6, 6)) > 0.005);
  }

  void gaps_areLeftOut() {
    DriveScenario scenario = driveScenario("none");
    scenario.imus[1].faults.lost_packets = 40;
    QVERIFY(trackOf(scenario, 0.01).steps.empty());
    const std::vector<PairWindow> windows = pairWindows(scenario);
    int points = 0, all = 0;
    for (const PairWindow& window : windows) points += window.gyroscope.count;
    for (const PairWindow& window : pairWindows(driveScenario("none"))) all += window.gyroscope.count;
    QVERIFY(points < all && points > all / 2);
  }
};

EVICAL_TEST(TestPairTracking)
#include "tst_pair_tracking.moc"
