#include "core/initialisation/gyro_rotation.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;
using Eigen::Vector3d;

namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

Vector3d swing(double t) {
  return {0.6 * std::sin(4.0 * t), 0.4 * std::sin(5.0 * t + 1.0), 0.3 * std::cos(3.0 * t)};
}
Vector3d swingRate(double t) {
  const Vector3d derivative(2.4 * std::cos(4.0 * t), 2.0 * std::cos(5.0 * t + 1.0), -0.9 * std::sin(3.0 * t));
  return so3RightJacobian(swing(t)) * derivative;
}

std::vector<ImuSample> swingSamples(double rate_hz, double duration_s, const Vector3d& bias) {
  std::vector<ImuSample> samples;
  for (int k = 0; k <= static_cast<int>(duration_s * rate_hz); ++k) {
    ImuSample sample;
    sample.time_ns = kStart_ns + nanosecondsFrom(0.5 + k / rate_hz);
    sample.angular_rate_rad_s = swingRate(0.5 + k / rate_hz) + bias;
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace

class TestGyroRotation : public QObject {
  Q_OBJECT

 private slots:
  void between_matchesTrueRotation_data() {
    QTest::addColumn<double>("rate_hz");
    QTest::addColumn<double>("tolerance_rad");
    QTest::newRow("1000 Hz") << 1000.0 << 1e-5;
    QTest::newRow("200 Hz") << 200.0 << 2e-4;
  }
  void between_matchesTrueRotation() {
    QFETCH(double, rate_hz);
    QFETCH(double, tolerance_rad);
    const Vector3d bias(0.01, -0.02, 0.015);
    const GyroRotation gyro(swingSamples(rate_hz, 4.0, bias), kStart_ns, bias);
    QVERIFY(std::abs(gyro.begin_s() - 0.5) < 1e-9);
    QVERIFY(std::abs(gyro.end_s() - 4.5) < 1e-9);
    for (double from_s = 0.6; from_s < 3.0; from_s += 0.37) {
      const double to_s = from_s + 0.9;
      const Vector3d expected =
          quaternionLog(quaternionExp(swing(from_s)).conjugate() * quaternionExp(swing(to_s)));
      QVERIFY((gyro.between(from_s, to_s) - expected).norm() < tolerance_rad);
    }
  }

  void between_bridgesGapAtConstantRate() {
    std::vector<ImuSample> samples;
    for (const double time_s : {0.0, 0.1, 0.2, 0.9, 1.0}) {
      ImuSample sample;
      sample.time_ns = kStart_ns + nanosecondsFrom(time_s);
      sample.angular_rate_rad_s = {0.0, 0.0, 0.5};
      samples.push_back(sample);
    }
    const GyroRotation gyro(samples, kStart_ns);
    QVERIFY((gyro.between(0.3, 0.5) - Vector3d(0.0, 0.0, 0.1)).norm() < 1e-9);
    double begin_s = 0.0;
    QVERIFY(std::abs(gyro.longestGap_s(&begin_s) - 0.7) < 1e-9);
    QVERIFY(std::abs(begin_s - 0.2) < 1e-9);
  }

  void rateRms_ignoresBias() {
    const GyroRotation plain(swingSamples(400.0, 10.0, Vector3d::Zero()), kStart_ns);
    const GyroRotation biased(swingSamples(400.0, 10.0, {0.3, 0.0, 0.0}), kStart_ns);
    QVERIFY(plain.rateRms_rad_s() > 1.0);
    QVERIFY(std::abs(biased.rateRms_rad_s() / plain.rateRms_rad_s() - 1.0) < 0.02);
  }

  void covers_endsWithSamples() {
    const GyroRotation gyro(swingSamples(400.0, 2.0, Vector3d::Zero()), kStart_ns);
    QVERIFY(gyro.covers(0.5, 2.5));
    QVERIFY(!gyro.covers(0.4, 1.0));
    QVERIFY(!gyro.covers(1.0, 2.6));
  }
};

EVICAL_TEST(TestGyroRotation)
#include "tst_gyro_rotation.moc"
