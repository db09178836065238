// Accelerometers whose samples are delayed relative to the gyroscope's.
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/optimisation/uncertainty/prior_check.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

constexpr double kDelay_s = 3e-3;

test::RigOptions lateRig(unsigned seed = 1, double delay_s = kDelay_s) {
  test::RigOptions options;
  options.duration_s = 6.0;
  options.imu_rate_hz = 200.0;
  options.window_s = 0.03;
  options.accelerometer_delay_s = delay_s;
  options.seed = seed;
  return options;
}

struct AccelerometerDelayRun {
  BatchSolution solution;
  UncertaintyReport report;

  double delay_s() const { return solution.state.imus[0].accelerometer_delay_s; }
  double delaySigma_s() const { return report.imus[0].accelerometer_delay_std_s; }
};
AccelerometerDelayRun calibrateForAccelerometerDelay(
    const test::SimulatedRig& rig, unsigned seed = 1,
    const OptimisationOptions& options = test::withoutPixelDelay()) {
  AccelerometerDelayRun run;
  run.solution = optimiseBatch(rig.input, test::disturbed(rig.truth, seed), options, RunContext{});
  run.report = estimateUncertainty(rig.input, run.solution, options, RunContext{}).report;
  return run;
}

// In sigmas.
double offsetError(const AccelerometerDelayRun& run, const CalibrationState& truth) {
  const CameraState& camera = run.solution.state.cameras[0];
  return (camera.time_offset_s - timeOffsetAt_s(truth.cameras[0], camera.time_offset_at_s)) /
         run.report.cameras[0].time_offset_std_s;
}

class TestAccelerometerDelay : public QObject {
  Q_OBJECT

 private slots:
  // Delays of the reference and of an IMU with a lever arm and a separate clock.
  void noiselessDelays_areFound() {
    test::RigOptions options = lateRig();
    options.centre_sigma_px = 0.0;
    options.imu_noise = 0.0;
    options.second_imu = true;
    const test::SimulatedRig rig = test::simulateRig(options);
    const AccelerometerDelayRun run = calibrateForAccelerometerDelay(rig);
    for (const ImuState& imu : run.solution.state.imus)
      QVERIFY2(std::abs(imu.accelerometer_delay_s - kDelay_s) < 2e-5,
               qPrintable(QString::number(imu.accelerometer_delay_s)));
    QVERIFY(std::abs(run.solution.state.imus[1].time_offset_s - rig.truth.imus[1].time_offset_s) < 1e-5);
  }

  // The RMS over 10 seeds is accurate to some 22 %.
  void delay_andTimeOffset_haveHonestSigmas() {
    constexpr unsigned kSeeds = 10;
    double delays = 0.0, offsets = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig = test::simulateRig(lateRig(seed));
      const AccelerometerDelayRun run = calibrateForAccelerometerDelay(rig, seed);
      const double delay = (run.delay_s() - kDelay_s) / run.delaySigma_s(),
                   offset = offsetError(run, rig.truth);
      QVERIFY2(std::abs(delay) < 4.0, qPrintable(QString::number(delay)));
      QVERIFY2(std::abs(offset) < 4.0, qPrintable(QString::number(offset)));
      QVERIFY2(run.delaySigma_s() < 5e-4, qPrintable(QString::number(run.delaySigma_s())));
      delays += delay * delay;
      offsets += offset * offset;
    }
    const double of_delays = std::sqrt(delays / kSeeds), of_offsets = std::sqrt(offsets / kSeeds);
    QVERIFY2(of_delays > 0.5 && of_delays < 1.6, qPrintable(QString::number(of_delays)));
    QVERIFY2(of_offsets > 0.5 && of_offsets < 1.6, qPrintable(QString::number(of_offsets)));
  }

  // A delay given as 0 although it is not: the recording contradicts it.
  void delayGivenAs0_spoilsTheTimeOffsetAndIsContradicted() {
    test::SimulatedRig rig = test::simulateRig(lateRig());
    rig.input.imus[0].prior.accelerometer_delay = KnownNumber{0.0};
    const AccelerometerDelayRun run = calibrateForAccelerometerDelay(rig);
    QCOMPARE(run.delay_s(), 0.0);
    QCOMPARE(run.report.given, std::vector<std::string>{"imu.accelerometer_delay"});
    QVERIFY2(std::abs(offsetError(run, rig.truth)) > 3.0,
             qPrintable(QString::number(offsetError(run, rig.truth))));
    const PriorCheck check = checkPriors(rig.input, run.solution, {}, RunContext{});
    QVERIFY(std::any_of(check.notes.begin(), check.notes.end(), [](const std::string& note) {
      return note.find("imu.accelerometer_delay: given as 0 ms") != std::string::npos;
    }));
  }

  // Loss of accuracy if the delay is zero.
  void promptAccelerometer_costsLittleCertainty() {
    test::SimulatedRig rig = test::simulateRig(lateRig(1, 0.0));
    const AccelerometerDelayRun free = calibrateForAccelerometerDelay(rig);
    rig.input.imus[0].prior.accelerometer_delay = KnownNumber{0.0};
    const AccelerometerDelayRun held = calibrateForAccelerometerDelay(rig);
    const CameraUncertainty &with = free.report.cameras[0], &without = held.report.cameras[0];
    QVERIFY2(with.time_offset_std_s < 1.25 * without.time_offset_std_s,
             qPrintable(QString::number(with.time_offset_std_s / without.time_offset_std_s)));
    QVERIFY(with.translation_std_m.norm() < 1.25 * without.translation_std_m.norm());
    QVERIFY(with.rotation_std_rad.norm() < 1.25 * without.rotation_std_rad.norm());
    QVERIFY(std::abs(free.delay_s()) < 4.0 * free.delaySigma_s());
  }

  void imuIntrinsicsThatAreNotFree_holdIt() {
    test::SimulatedRig rig = test::simulateRig(lateRig());
    OptimisationOptions options;
    options.free_imu_intrinsics = false;
    const auto isGiven = [](const AccelerometerDelayRun& run) {
      const std::vector<std::string>& given = run.report.given;
      return std::find(given.begin(), given.end(), "imu.accelerometer_delay") != given.end();
    };
    const AccelerometerDelayRun held = calibrateForAccelerometerDelay(rig, 1, options);
    QCOMPARE(held.delay_s(), 0.0);
    QCOMPARE(held.delaySigma_s(), 0.0);
    QVERIFY(isGiven(held));
    rig.input.imus[0].prior.accelerometer_delay = KnownNumber{2e-3, 1e-3};
    const AccelerometerDelayRun known = calibrateForAccelerometerDelay(rig, 1, options);
    QCOMPARE(known.delay_s(), 2e-3);
    QVERIFY(isGiven(known));
  }

  void weighedDelay_isBetterThanEither() {
    test::SimulatedRig rig = test::simulateRig(lateRig());
    const double alone_s = calibrateForAccelerometerDelay(rig).delaySigma_s();
    rig.input.imus[0].prior.accelerometer_delay = KnownNumber{kDelay_s + 0.5 * alone_s, alone_s};
    const AccelerometerDelayRun run = calibrateForAccelerometerDelay(rig);
    QVERIFY2(run.delaySigma_s() > 0.4 * alone_s && run.delaySigma_s() < 0.85 * alone_s,
             qPrintable(QString::number(run.delaySigma_s() / alone_s)));
    QVERIFY(std::abs(run.delay_s() - kDelay_s) < 4.0 * run.delaySigma_s());
  }

  // Without motion the delay is not observable.
  void withoutMotion_thePriorHolds() {
    test::RigOptions simulation = lateRig();
    simulation.motion = test::Motion::HardlyMoving;
    const AccelerometerDelayRun run = calibrateForAccelerometerDelay(test::simulateRig(simulation));
    QVERIFY2(run.delaySigma_s() > 1e-3 && run.delaySigma_s() < 5.1e-3,
             qPrintable(QString::number(run.delaySigma_s())));
    QVERIFY2(std::abs(run.delay_s() - kDelay_s) < 4.0 * run.delaySigma_s(),
             qPrintable(QString::number(run.delay_s())));
  }
};

}  // namespace

EVICAL_TEST(TestAccelerometerDelay)
#include "tst_accelerometer_delay.moc"
