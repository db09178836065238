// Clocks whose rate differs from the reference's.
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

constexpr double kDrift_ppm = 40.0;

test::RigOptions driftingRig(unsigned seed = 1) {
  test::RigOptions options;
  options.duration_s = 8.0;
  options.imu_rate_hz = 200.0;
  options.window_s = 0.03;
  options.time_offset_drift_ppm = kDrift_ppm;
  options.seed = seed;
  return options;
}

OptimisationOptions withPrior(double sigma_ppm) {
  OptimisationOptions options;
  options.time_offset_drift_sigma_ppm = sigma_ppm;
  return options;
}

OptimisationOptions withoutDrift() {
  OptimisationOptions options;
  options.time_offset_drift = false;
  return options;
}

std::optional<Eigen::Index> placeOf(const UncertaintyReport& report, QuantityId id) {
  return columnOf({QuantityOwner::Camera, 0, id}, report.columns);
}

class TestTimeOffsetDrift : public QObject {
  Q_OBJECT

 private slots:
  // Drift of a camera and of a second IMU, with a weak prior.
  void noiselessDrifts_areFound() {
    test::RigOptions options = driftingRig();
    options.centre_sigma_px = 0.0;
    options.imu_noise = 0.0;
    options.second_imu = true;
    const test::SimulatedRig rig = test::simulateRig(options);
    const BatchSolution solution =
        optimiseBatch(rig.input, test::disturbed(rig.truth, 1), withPrior(1e4), RunContext{});
    const CameraState& camera = solution.state.cameras[0];
    QVERIFY2(std::abs(camera.time_offset_drift_ppm - kDrift_ppm) < 2.0,
             qPrintable(QString::number(camera.time_offset_drift_ppm)));
    const ImuState& imu = solution.state.imus[1];
    QVERIFY2(std::abs(imu.time_offset_drift_ppm + kDrift_ppm) < 2.0,
             qPrintable(QString::number(imu.time_offset_drift_ppm)));
    for (const double time_s : {0.0, 4.0, 8.0}) {
      QVERIFY(std::abs(timeOffsetAt_s(camera, time_s) - timeOffsetAt_s(rig.truth.cameras[0], time_s)) < 1e-5);
      QVERIFY(std::abs(timeOffsetAt_s(imu, time_s) - timeOffsetAt_s(rig.truth.imus[1], time_s)) < 1e-5);
    }
  }

  // The drifts' RMS over 10 seeds is accurate to some 22 %.
  void sigmas_areHonest() {
    constexpr unsigned kSeeds = 10;
    double drifts = 0.0, offsets = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig = test::simulateRig(driftingRig(seed));
      const OptimisationOptions options = test::withoutPixelDelay(withPrior(1e4));
      const BatchSolution solution =
          optimiseBatch(rig.input, test::disturbed(rig.truth, seed), options, RunContext{});
      const UncertaintyReport report = estimateUncertainty(rig.input, solution, options, RunContext{}).report;
      const Eigen::VectorXd errors = test::reportedErrors(solution.state, rig.truth, options);
      const Eigen::Index offset = placeOf(report, QuantityId::TimeOffset).value(),
                         drift = placeOf(report, QuantityId::TimeOffsetDrift).value();
      QCOMPARE(drift, offset + 1);
      QCOMPARE(report.cameras[0].time_offset_drift_std_ppm, report.standard_deviations[drift]);
      QVERIFY(report.cameras[0].time_offset_drift_std_ppm > 0.0);
      drifts += std::pow(errors[drift] / report.standard_deviations[drift], 2);
      offsets += std::pow(errors[offset] / report.standard_deviations[offset], 2);
      // At the middle of the recording the two are uncorrelated.
      QVERIFY2(std::abs(report.correlation(offset, drift)) < 0.5,
               qPrintable(QString::number(report.correlation(offset, drift))));
    }
    const double of_drifts = std::sqrt(drifts / kSeeds), of_offsets = std::sqrt(offsets / kSeeds);
    QVERIFY2(of_drifts > 0.5 && of_drifts < 1.6, qPrintable(QString::number(of_drifts)));
    QVERIFY2(of_offsets > 0.5 && of_offsets < 1.6, qPrintable(QString::number(of_offsets)));
  }

  // This is the default.
  void drift_isFoundByDefault() {
    const test::SimulatedRig rig = test::simulateRig(driftingRig());
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    const UncertaintyReport report = estimateUncertainty(rig.input, solution, {}, RunContext{}).report;
    const double error_ppm = solution.state.cameras[0].time_offset_drift_ppm - kDrift_ppm;
    QVERIFY2(std::abs(error_ppm) < 4.0 * report.cameras[0].time_offset_drift_std_ppm,
             qPrintable(QString::number(error_ppm)));
    QVERIFY(report.cameras[0].time_offset_drift_std_ppm < 0.5 * kDrift_ppm);
  }

  void withoutTheOption_nothingDrifts() {
    const test::SimulatedRig rig = test::simulateRig(driftingRig());
    const OptimisationOptions options = withoutDrift();
    const BatchSolution solution =
        optimiseBatch(rig.input, test::disturbed(rig.truth, 1), options, RunContext{});
    QCOMPARE(solution.state.cameras[0].time_offset_drift_ppm, 0.0);
    const UncertaintyReport report = estimateUncertainty(rig.input, solution, options, RunContext{}).report;
    QCOMPARE(report.cameras[0].time_offset_drift_std_ppm, 0.0);
    QVERIFY(!placeOf(report, QuantityId::TimeOffsetDrift));
    QVERIFY(report.given.empty());
  }

  // A given offset implies one clock, unless a prior states that there are two.
  void givenOffset_doesNotDrift() {
    test::SimulatedRig rig = test::simulateRig(driftingRig());
    SensorPrior& prior = rig.input.cameras[0].prior;
    prior.time_offset = KnownNumber{rig.truth.cameras[0].time_offset_s + 1e-6 * kDrift_ppm * 4.0};
    BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    QCOMPARE(solution.state.cameras[0].time_offset_drift_ppm, 0.0);
    UncertaintyReport report = estimateUncertainty(rig.input, solution, {}, RunContext{}).report;
    QCOMPARE(report.given, std::vector<std::string>{"left.time_offset"});

    prior.time_offset_drift = KnownNumber{0.0, 1e4};
    solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    report = estimateUncertainty(rig.input, solution, {}, RunContext{}).report;
    QVERIFY(std::abs(solution.state.cameras[0].time_offset_drift_ppm - kDrift_ppm) <
            4.0 * report.cameras[0].time_offset_drift_std_ppm);
  }

  // Also without the option: a prior of the session enables it.
  void knownDrift_isHeldOrWeighed() {
    test::SimulatedRig rig = test::simulateRig(driftingRig());
    const OptimisationOptions options = withoutDrift();
    std::optional<KnownNumber>& prior = rig.input.cameras[0].prior.time_offset_drift;
    prior = KnownNumber{kDrift_ppm};
    BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), options, RunContext{});
    QCOMPARE(solution.state.cameras[0].time_offset_drift_ppm, kDrift_ppm);
    UncertaintyReport report = estimateUncertainty(rig.input, solution, options, RunContext{}).report;
    QCOMPARE(report.given, std::vector<std::string>{"left.time_offset_drift"});
    QCOMPARE(report.cameras[0].time_offset_drift_std_ppm, 0.0);

    prior = KnownNumber{kDrift_ppm + 0.5, 0.5};
    solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), options, RunContext{});
    report = estimateUncertainty(rig.input, solution, options, RunContext{}).report;
    const double sigma_ppm = report.cameras[0].time_offset_drift_std_ppm;
    QVERIFY2(sigma_ppm > 0.1 && sigma_ppm < 0.55, qPrintable(QString::number(sigma_ppm)));
    QVERIFY(std::abs(solution.state.cameras[0].time_offset_drift_ppm - kDrift_ppm) < 4.0 * 0.5);
    QVERIFY(report.given.empty());
  }
};

}  // namespace

EVICAL_TEST(TestTimeOffsetDrift)
#include "tst_time_offset_drift.moc"
