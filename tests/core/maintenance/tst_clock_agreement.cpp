// Time offset between two IMUs' clocks, from the norms of their rates.
#include "core/maintenance/clock_agreement.h"
#include "core/maintenance/maintenance_options.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;

namespace {

// A shake whose norm determines its time, at 200 Hz.
AngularSpeedSeries shaken(double from_s, double to_s, double later_s) {
  AngularSpeedSeries norms;
  const auto first = static_cast<int>(std::lround(from_s / 0.005)),
             last = static_cast<int>(std::lround(to_s / 0.005));
  for (int i = first; i < last; ++i) {
    const double time_s = 0.005 * i + 0.001;  // away from the borders of bins
    const double t = time_s - later_s;
    norms.add(time_s, {1.0 + std::sin(3.1 * t) + 0.4 * std::sin(7.7 * t), 0.2 * std::sin(1.3 * t), 0.0});
  }
  return norms;
}

}  // namespace

class TestClockAgreement : public QObject {
  Q_OBJECT

 private slots:
  void offset_isFoundBetweenBins() {
    for (const double later_s : {0.0, 0.0234, -0.3167}) {
      const ClockAgreement found =
          crossCorrelateClocks(shaken(0.0, 20.0, 0.0), shaken(0.0, 20.0, -later_s), MaintenanceOptions());
      QVERIFY(found.moved && found.correlation > 0.98);
      QVERIFY2(std::abs(found.later_s - later_s) < 0.002, qPrintable(QString::number(found.later_s)));
    }
  }

  // Lags with too little overlap have no correlation, and do not affect the parabola.
  void shortOverlap_movesNothing() {
    for (const double overlap_s : {3.02, 3.1, 3.3}) {
      const ClockAgreement found = crossCorrelateClocks(
          shaken(0.0, 20.0, 0.0), shaken(20.0 - overlap_s, 40.0, 0.0), MaintenanceOptions());
      QVERIFY(found.moved);
      QVERIFY2(std::abs(found.later_s) < 0.003,
               qPrintable(QString("%1: %2").arg(overlap_s).arg(found.later_s)));
    }
  }
};

EVICAL_TEST(TestClockAgreement)
#include "tst_clock_agreement.moc"
