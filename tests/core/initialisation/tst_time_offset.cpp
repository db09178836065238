#include "core/initialisation/time_offset.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

std::vector<TimeOffsetPeak> peaksOf(const SimulationOptions& simulation, const InitialisationOptions& options,
                                    const SensorPrior& prior = {}) {
  const SimulatedInput simulated = simulateInput(simulation);
  const auto found = estimateCameraPoses(simulated.input.cameras[0], simulated.input.board, {});
  return correlateTimeOffset(
      found.poses, GyroRotation(simulated.input.imus[0].samples, simulated.input.start_ns), options, prior);
}

}  // namespace

class TestTimeOffset : public QObject {
  Q_OBJECT

 private slots:
  void correlate_findsOffset_data() {
    QTest::addColumn<double>("offset_s");
    QTest::addColumn<double>("search_s");
    QTest::addColumn<double>("missing_share");
    QTest::newRow("-0.95 s") << -0.95 << 1.0 << 0.0;
    QTest::newRow("-0.4 s") << -0.4 << 1.0 << 0.0;
    QTest::newRow("0.01 s") << 0.01 << 1.0 << 0.0;
    QTest::newRow("0.4 s, 40 % missing") << 0.4 << 1.0 << 0.4;
    QTest::newRow("0.9 s, 40 % missing") << 0.9 << 1.0 << 0.4;
    QTest::newRow("0.2 s within 60 s") << 0.2 << 60.0 << 0.3;
    QTest::newRow("7 s within 60 s") << 7.0 << 60.0 << 0.3;
    QTest::newRow("-12 s within 60 s: a third overlaps") << -12.0 << 60.0 << 0.0;
  }
  void correlate_findsOffset() {
    QFETCH(double, offset_s);
    QFETCH(double, search_s);
    QFETCH(double, missing_share);
    SimulationOptions simulation;
    simulation.duration_s = 18.0;
    simulation.time_offset_s = offset_s;
    simulation.missing_share = missing_share;
    InitialisationOptions options;
    options.time_offset_search_s = search_s;
    const auto peaks = peaksOf(simulation, options);
    QVERIFY(!peaks.empty());
    QVERIFY2(std::abs(peaks[0].time_offset_s - offset_s) < 0.01,
             qPrintable(QString::number(peaks[0].time_offset_s)));
    QVERIFY(peaks[0].correlation > 0.95);
    if (peaks.size() > 1) QVERIFY(peaks[1].correlation < peaks[0].correlation - options.clear_peak_lead);
  }

  void correlate_aroundAPrior_reachesFurther() {
    SimulationOptions simulation;
    simulation.duration_s = 15.0;
    simulation.time_offset_s = 3.0;
    SensorPrior prior;
    prior.time_offset = KnownNumber{2.6, 0.2};
    const auto peaks = peaksOf(simulation, {}, prior);
    QVERIFY(!peaks.empty());
    QVERIFY(std::abs(peaks[0].time_offset_s - 3.0) < 0.01);
    QVERIFY(peaks[0].correlation > 0.95);
  }

  void correlate_atAGivenOffset_looksNowhereElse() {
    SimulationOptions simulation;
    simulation.duration_s = 10.0;
    simulation.time_offset_s = 0.3;
    SensorPrior prior;
    for (const double given_s : {0.3, 0.05}) {
      prior.time_offset = KnownNumber{given_s};
      const auto peaks = peaksOf(simulation, {}, prior);
      QCOMPARE(peaks.size(), std::size_t{1});
      QCOMPARE(peaks[0].time_offset_s, given_s);
      QVERIFY(given_s == 0.3 ? peaks[0].correlation > 0.95 : peaks[0].correlation < 0.9);
    }
  }

  void correlate_onPeriodicMotion_showsRival() {
    SimulationOptions simulation;
    simulation.duration_s = 12.0;
    simulation.time_offset_s = 0.3;
    simulation.motion = Motion::Periodic;
    const InitialisationOptions options;
    const auto peaks = peaksOf(simulation, options);
    QVERIFY(peaks.size() > 1);
    QVERIFY(peaks[0].correlation - peaks[1].correlation < options.clear_peak_lead);
    const bool among = std::any_of(peaks.begin(), peaks.end(),
                                   [](const auto& p) { return std::abs(p.time_offset_s - 0.3) < 0.01; });
    QVERIFY(among);
  }

  void correlate_outOfReach_hasNoClearPeak() {
    SimulationOptions simulation;
    simulation.duration_s = 15.0;
    simulation.time_offset_s = 3.0;
    const InitialisationOptions options;
    for (const TimeOffsetPeak& peak : peaksOf(simulation, options))
      QVERIFY(peak.correlation < options.clear_peak_correlation);
  }

  void correlate_withoutOverlap_givesNothing() {
    SimulationOptions simulation;
    simulation.duration_s = 8.0;
    simulation.imu_end_s = 2.5;
    InitialisationOptions options;
    options.time_offset_search_s = 0.1;
    QVERIFY(peaksOf(simulation, options).empty());
  }
};

EVICAL_TEST(TestTimeOffset)
#include "tst_time_offset.moc"
