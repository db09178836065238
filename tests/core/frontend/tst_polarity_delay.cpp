// Delay of brightening edges relative to darkening ones, estimated from the apparent growth of circles with
// speed.
#include "core/frontend/edge_crossings.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <random>

namespace {

using namespace evical;

constexpr double kOffset_px = -0.56, kNoise_px = 0.005;

// Windows with speeds of a hand-held camera, with pixels whose brightening edges are delayed by this.
PolarityDelayFit windows(double later_s, double sign, int count, double min_px_s, double max_px_s,
                         unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, kNoise_px);
  PolarityDelayFit fit;
  for (int i = 0; i < count; ++i) {
    const double speed = min_px_s + (max_px_s - min_px_s) * (0.5 + 0.5 * std::sin(0.7 * i));
    fit.add(speed, kOffset_px + 0.5 * sign * later_s * speed + noise(random));
  }
  return fit;
}

class TestPolarityDelay : public QObject {
  Q_OBJECT

 private slots:
  void delay_isFoundWithinItsSigma_data() {
    QTest::addColumn<double>("later_ms");
    QTest::newRow("none") << 0.0;
    QTest::newRow("brightening later") << 1.5;
    QTest::newRow("darkening later") << -8.0;
  }
  void delay_isFoundWithinItsSigma() {
    QFETCH(double, later_ms);
    double squares = 0.0;
    constexpr int kSeeds = 50;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const auto found = windows(1e-3 * later_ms, 1.0, 200, 30.0, 150.0, seed).result(CircleShade::Dark);
      QVERIFY(found);
      QVERIFY(found->std_s < 1e-4);
      squares += std::pow((found->later_s - 1e-3 * later_ms) / found->std_s, 2);
    }
    const double rms = std::sqrt(squares / kSeeds);
    QVERIFY2(rms > 0.8 && rms < 1.2, QByteArray::number(rms));
  }

  void brightCircles_shrinkWhereDarkOnesGrow() {
    const PolarityDelayFit fit = windows(2e-3, -1.0, 200, 30.0, 150.0);
    QVERIFY(std::abs(fit.result(CircleShade::Bright)->later_s - 2e-3) < 2e-4);
    QVERIFY(std::abs(fit.result(CircleShade::Dark)->later_s + 2e-3) < 2e-4);
  }

  void whatCannotTell_saysNothing_data() {
    QTest::addColumn<int>("count");
    QTest::addColumn<double>("min_px_s");
    QTest::addColumn<double>("max_px_s");
    QTest::newRow("no window") << 0 << 30.0 << 150.0;
    QTest::newRow("few windows") << 10 << 30.0 << 150.0;
    QTest::newRow("one speed") << 500 << 60.0 << 61.0;
    QTest::newRow("hardly moving") << 500 << 1.0 << 15.0;
  }
  void whatCannotTell_saysNothing() {
    QFETCH(int, count);
    QFETCH(double, min_px_s);
    QFETCH(double, max_px_s);
    QVERIFY(!windows(2e-3, 1.0, count, min_px_s, max_px_s).result(CircleShade::Dark));
  }
};

}  // namespace

EVICAL_TEST(TestPolarityDelay)
#include "tst_polarity_delay.moc"
