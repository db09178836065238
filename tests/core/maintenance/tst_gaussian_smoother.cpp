// Smoothed signals do not depend on sample times; slopes are those of the smoothed signal; gaps are detected.
#include "core/maintenance/imu_pairs.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;

namespace {

constexpr double kSigma_s = 0.02, kTurn_rad_s = 12.0;

GaussianSmoother smootherOf(double rate_hz, double phase_s, double gap_from_s = -1.0) {
  GaussianSmoother smoother(kSigma_s);
  for (int k = 0; k < 1000; ++k) {
    const double t = phase_s + k / rate_hz;
    if (t > gap_from_s && t < gap_from_s + 0.06) continue;
    const double wave = std::sin(kTurn_rad_s * t);
    smoother.add(t, Eigen::Vector3d(wave, 2.0, 0.0), Eigen::Vector3d(0.0, wave, 9.81));
  }
  return smoother;
}

}  // namespace

class TestGaussianSmoother : public QObject {
  Q_OBJECT

 private slots:
  void valueAndSlope_areTheConvolutions_data() {
    QTest::addColumn<double>("rate_hz");
    QTest::addColumn<double>("phase_s");
    QTest::newRow("200 Hz") << 200.0 << 0.0;
    QTest::newRow("200 Hz, between") << 200.0 << 0.0021;
    QTest::newRow("333 Hz") << 333.0 << 0.0007;
    QTest::newRow("100 Hz, two samples a sigma") << 100.0 << 0.003;
  }
  void valueAndSlope_areTheConvolutions() {
    QFETCH(const double, rate_hz);
    QFETCH(const double, phase_s);
    const auto point = smootherOf(rate_hz, phase_s).at(1.234);
    QVERIFY(point.has_value());
    const double damped = std::exp(-0.5 * std::pow(kTurn_rad_s * kSigma_s, 2));
    const double value = damped * std::sin(kTurn_rad_s * 1.234),
                 slope = damped * kTurn_rad_s * std::cos(kTurn_rad_s * 1.234);
    // Truncation of the Gaussian at five sigmas costs 1.5e-5 of a slope.
    QVERIFY(std::abs(point->rate_rad_s.x() - value) < 1e-5);
    QVERIFY(std::abs(point->rate_slope_rad_s2.x() - slope) < 5e-5 * kTurn_rad_s);
    QVERIFY(std::abs(point->force_slope_m_s3.y() - slope) < 5e-5 * kTurn_rad_s);
    QVERIFY(std::abs(point->rate_slope_rad_s2.y()) < 1e-9);
    QVERIFY(std::abs(point->rate_products(1, 1) - 4.0) < 1e-9);
  }

  void gaps_giveNothing() {
    const GaussianSmoother smoother = smootherOf(200.0, 0.0, 1.2);
    QVERIFY(!smoother.at(1.23).has_value());
    QVERIFY(smoother.at(1.0).has_value());
    QVERIFY(!smoother.at(-1.0).has_value());
    QVERIFY(!smoother.at(100.0).has_value());
  }

  // Sensors that are sampled separately: the other one's interpolated values do not hide a gap, and do not
  // count.
  void gapsOfOneSensor_giveNothing() {
    GaussianSmoother smoother(kSigma_s);
    const Eigen::Vector3d rate(0.1, 0.2, 0.3), force(0.0, 0.0, 9.81), invented(9.0, 9.0, 9.0);
    for (int k = 0; k < 1000; ++k) {
      const double t = k / 200.0;
      smoother.add(t, rate, invented, MeasuredBy::Gyroscope);
      if (t < 2.0 || t > 2.1) smoother.add(t + 0.001, invented, force, MeasuredBy::Accelerometer);
    }
    const auto point = smoother.at(1.0);
    QVERIFY(point.has_value());
    QVERIFY((point->rate_rad_s - rate).norm() < 1e-9 && (point->force_m_s2 - force).norm() < 1e-9);
    QVERIFY(!smoother.at(2.05).has_value());
  }

  void memory_isThatOfTheReach() {
    GaussianSmoother smoother = smootherOf(200.0, 0.0);
    smoother.forgetBefore(4.0);
    QVERIFY(smoother.at(4.0).has_value());
    QVERIFY(!smoother.at(1.0).has_value());
  }
};

EVICAL_TEST(TestGaussianSmoother)
#include "tst_gaussian_smoother.moc"
