#include "core/base/error.h"
#include "core/optimisation/sample_errors.h"
#include "core/report/residual_statistics.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

SignalPrediction predict(const SimulatedRig& rig, const CalibrationState& state, std::size_t imu) {
  return predictSignals(rig.input.imus[imu], rig.input.start_ns, state, imu);
}

double rms(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]).squaredNorm();
  return std::sqrt(sum / (3.0 * static_cast<double>(a.size())));
}

}  // namespace

class TestSignalPrediction : public QObject {
  Q_OBJECT

  // Two IMUs, the second with a lever arm and a separate clock; delayed accelerometers; no noise.
  SimulatedRig rig_;

 private slots:
  void initTestCase() {
    RigOptions options;
    options.duration_s = 3.0;
    options.imu_noise = 0.0;
    options.second_imu = true;
    options.accelerometer_delay_s = 0.004;
    rig_ = simulateRig(options);
  }

  void prediction_fromTheTruthIsWhatWasMeasured_data() {
    QTest::addColumn<int>("imu");
    QTest::newRow("reference") << 0;
    QTest::newRow("second, with lever arm and time offset") << 1;
  }
  void prediction_fromTheTruthIsWhatWasMeasured() {
    QFETCH(int, imu);
    const SignalPrediction prediction = predict(rig_, rig_.truth, static_cast<std::size_t>(imu));
    QVERIFY(prediction.rate_rad_s.time_s.size() > 1000);
    // Error of the second derivatives of a spline of 20 ms for these sinusoids; the predictions are some 2
    // rad/s and 10 m/s^2.
    QVERIFY2(rms(prediction.rate_rad_s.measured, prediction.rate_rad_s.predicted) < 1e-3, "rad/s");
    QVERIFY2(rms(prediction.force_m_s2.measured, prediction.force_m_s2.predicted) < 0.02, "m/s^2");
  }

  void prediction_ofAStateThatIsOffIsOffAsTheOptimiserSays() {
    const CalibrationState off = disturbed(rig_.truth, 1);
    for (std::size_t imu = 0; imu < 2; ++imu) {
      const SignalPrediction prediction = predict(rig_, off, imu);
      const SampleErrors errors = sampleErrors(rig_.input, off, imu);
      QCOMPARE(static_cast<int>(prediction.force_m_s2.time_s.size()), errors.accelerometer_samples);
      QCOMPARE(rms(prediction.rate_rad_s.measured, prediction.rate_rad_s.predicted),
               errors.gyroscope_rms_rad_s);
      QCOMPARE(rms(prediction.force_m_s2.measured, prediction.force_m_s2.predicted),
               errors.accelerometer_rms_m_s2);
      QVERIFY(errors.gyroscope_rms_rad_s > 5e-3);
    }
  }

  void times_areOfTheImusOwnClockAndWithinTheSplines() {
    const SignalPrediction prediction = predict(rig_, rig_.truth, 1);
    const double offset_s = rig_.truth.imus[1].time_offset_s;
    QVERIFY(std::is_sorted(prediction.rate_rad_s.time_s.begin(), prediction.rate_rad_s.time_s.end()));
    QVERIFY(rig_.truth.imu_in_world_m.contains(prediction.rate_rad_s.time_s.front() + offset_s));
    QVERIFY(rig_.truth.imu_in_world_m.contains(prediction.rate_rad_s.time_s.back() + offset_s));
    const double first_sample_s =
        static_cast<double>(rig_.input.imus[1].samples.front().time_ns - rig_.input.start_ns) * 1e-9;
    QVERIFY(prediction.rate_rad_s.time_s.front() - first_sample_s < 0.01);
  }

  void sensorsWithSamplesOfTheirOwn_haveSignalsOfTheirOwn() {
    ImuData data = rig_.input.imus[0];
    const std::size_t count = data.samples.size();
    for (std::size_t i = 0; i < count; ++i)
      data.samples[i].measured_by = i % 4 == 0 ? MeasuredBy::Accelerometer : MeasuredBy::Gyroscope;
    const SignalPrediction prediction = predictSignals(data, rig_.input.start_ns, rig_.truth, 0);
    QVERIFY(prediction.rate_rad_s.time_s.size() > 2 * prediction.force_m_s2.time_s.size());
    QCOMPARE(prediction.rate_rad_s.measured.size(), prediction.rate_rad_s.time_s.size());
    QVERIFY(rms(prediction.force_m_s2.measured, prediction.force_m_s2.predicted) < 0.02);
  }

  void stopping_isHeard() {
    std::stop_source stop;
    stop.request_stop();
    const RunContext context{silentProgress(), stop.get_token()};
    QVERIFY_THROWS_EXCEPTION(Cancelled,
                             predictSignals(rig_.input.imus[0], rig_.input.start_ns, rig_.truth, 0, context));
  }
};

EVICAL_TEST(TestSignalPrediction)
#include "tst_signal_prediction.moc"
