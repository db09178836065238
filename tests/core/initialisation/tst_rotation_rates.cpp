#include "core/initialisation/rotation_rates.h"

#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;

class TestRotationRates : public QObject {
  Q_OBJECT

  test::SimulatedPass simulated_;

 private slots:
  void initTestCase() { simulated_ = test::simulatePass(6.0); }

  void rotationRates_agreeOnlyWithTheTimeOffset() {
    // The simulated clocks differ by 7.3 ms: with the true offset, only the noise of single views remains.
    const CameraState camera{{}, simulated_.truth.cameras[0].time_offset_s, 0.0};
    ImuState imu;
    imu.gyroscope_bias_rad_s = simulated_.truth.imus[0].gyroscope_bias_rad_s;
    imu.gyroscope_scale_misalignment = simulated_.truth.imus[0].gyroscope_scale_misalignment;
    const SessionCamera& known = simulated_.session.cameras[0];
    const auto ratesWith = [&](const CameraState& state) {
      return rotationRates({known.name, simulated_.detections.lenses[0], simulated_.detections.cameras[0]},
                           simulated_.session.board, state, simulated_.detections.imus[0], imu,
                           simulated_.detections.start_ns, {}, {});
    };
    const RotationRates rates = ratesWith(camera);
    QVERIFY(rates.time_s.size() > 200);
    QVERIFY(rates.rmsDifferenceAfter_rad_s() < 0.7 * rates.rmsDifferenceBefore_rad_s());
    CameraState off = camera;
    off.time_offset_s += 0.02;
    QVERIFY(ratesWith(off).rmsDifferenceAfter_rad_s() > 2.0 * rates.rmsDifferenceAfter_rad_s());
    CameraState none = camera;
    none.time_offset_s = 0.0;
    const RotationRates unshifted = ratesWith(none);
    QCOMPARE(unshifted.rmsDifferenceAfter_rad_s(), unshifted.rmsDifferenceBefore_rad_s());
  }

  void rateRatio_isThatOfTheUnit_data() {
    QTest::addColumn<double>("times");
    for (const double times : {1.0, 0.0174533, 57.29578, 1e3, 0.7, 2.0}) QTest::addRow("%g", times) << times;
  }
  void rateRatio_isThatOfTheUnit() {
    QFETCH(double, times);
    const SessionCamera& known = simulated_.session.cameras[0];
    ImuData imu = simulated_.detections.imus[0];
    for (ImuSample& sample : imu.samples) sample.angular_rate_rad_s *= times;
    const std::optional<RateRatio> found =
        rateRatio({known.name, simulated_.detections.lenses[0], simulated_.detections.cameras[0]},
                  simulated_.session.board, imu, simulated_.detections.start_ns, {}, {});
    QVERIFY(found);
    constexpr double kTolerance = 0.03;  // the gyroscope's scale and the noise of views
    QVERIFY2(std::abs(found->ratio / times - 1.0) < kTolerance, qPrintable(QString::number(found->ratio)));
  }

  // A gyroscope of another recording, or with a mirrored axis, has no ratio.
  void rateRatio_ofAnotherMotion_isEmpty() {
    const SessionCamera& known = simulated_.session.cameras[0];
    ImuData imu = simulated_.detections.imus[0];
    for (ImuSample& sample : imu.samples) sample.angular_rate_rad_s.x() *= -1.0;
    QVERIFY(!rateRatio({known.name, simulated_.detections.lenses[0], simulated_.detections.cameras[0]},
                       simulated_.session.board, imu, simulated_.detections.start_ns, {}, {}));
  }

  void rmsDifferences_areThoseByHand() {
    RotationRates rates;
    QCOMPARE(rates.rmsDifferenceBefore_rad_s(), 0.0);
    rates.camera_rad_s = {1.0, 2.0};
    rates.imu_before_rad_s = {1.3, 1.6};
    rates.imu_after_rad_s = {1.0, 2.0};
    QVERIFY(std::abs(rates.rmsDifferenceBefore_rad_s() - std::sqrt(0.125)) < 1e-12);
    QCOMPARE(rates.rmsDifferenceAfter_rad_s(), 0.0);
  }
};

EVICAL_TEST(TestRotationRates)
#include "tst_rotation_rates.moc"
