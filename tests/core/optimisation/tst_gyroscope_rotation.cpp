// A gyroscope that is misaligned with its accelerometer.
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>

namespace {

using namespace evical;

constexpr double kTurn_rad = 0.014;  // 0.8 deg

test::RigOptions turnedRig(unsigned seed = 1) {
  test::RigOptions options;
  options.duration_s = 4.0;
  options.imu_rate_hz = 200.0;
  options.window_s = 0.03;
  options.gyroscope_turn_rad = kTurn_rad;
  options.seed = seed;
  return options;
}

OptimisationOptions withRotation() {
  OptimisationOptions options;
  options.gyroscope_rotation = Estimated::Yes;
  return options;
}

double turnError_rad(const ImuState& a, const ImuState& b) {
  return a.gyroscope_from_accelerometer.angularDistance(b.gyroscope_from_accelerometer);
}

class TestGyroscopeRotation : public QObject {
  Q_OBJECT

 private slots:
  void noiselessTurns_areFound() {
    test::RigOptions options = turnedRig();
    options.centre_sigma_px = 0.0;
    options.imu_noise = 0.0;
    options.second_imu = true;
    const test::SimulatedRig rig = test::simulateRig(options);
    OptimisationOptions exact = withRotation();
    exact.displacement_px = exact.displacement_px2_s = 0.0;  // as in these circles
    const BatchSolution solution =
        optimiseBatch(rig.input, test::disturbed(rig.truth, 1), exact, RunContext{});
    for (std::size_t i = 0; i < 2; ++i)
      QVERIFY(turnError_rad(solution.state.imus[i], rig.truth.imus[i]) < 1e-4);
    const CameraState &camera = solution.state.cameras[0], &truth = rig.truth.cameras[0];
    QVERIFY(camera.reference_from_camera.rotation.angularDistance(truth.reference_from_camera.rotation) <
            1e-4);
    QVERIFY((camera.reference_from_camera.translation_m - truth.reference_from_camera.translation_m).norm() <
            2e-4);
  }

  // 34 quantities over 10 seeds: their joint RMS is accurate to some 8 %, that of the rotations to 13 %.
  void sigmas_areHonest() {
    constexpr unsigned kSeeds = 10;
    double all = 0.0, turns = 0.0, count = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig = test::simulateRig(turnedRig(seed));
      const BatchSolution solution =
          optimiseBatch(rig.input, test::disturbed(rig.truth, seed), withRotation(), RunContext{});
      const UncertaintyReport report =
          estimateUncertainty(rig.input, solution, withRotation(), RunContext{}).report;
      const Eigen::VectorXd normalised = test::reportedErrors(solution.state, rig.truth, withRotation())
                                             .cwiseQuotient(report.standard_deviations);
      const Eigen::Index turn =
          columnOf({QuantityOwner::Imu, 0, QuantityId::GyroscopeRotation}, report.columns).value();
      QCOMPARE(report.imus[0].gyroscope_rotation_std_rad[0], report.standard_deviations[turn]);
      all += normalised.squaredNorm();
      turns += normalised.segment<3>(turn).squaredNorm();
      count += static_cast<double>(normalised.size());
      QVERIFY(turnError_rad(solution.state.imus[0], rig.truth.imus[0]) < 0.2 * kTurn_rad);
    }
    const double common = std::sqrt(all / count), of_turns = std::sqrt(turns / (3.0 * kSeeds));
    QVERIFY2(common > 0.8 && common < 1.25, qPrintable(QString::number(common)));
    QVERIFY2(of_turns > 0.65 && of_turns < 1.45, qPrintable(QString::number(of_turns)));
  }

  void withoutTheOption_nothingTurns() {
    const test::SimulatedRig rig = test::simulateRig(turnedRig());
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    QVERIFY(solution.state.imus[0].gyroscope_from_accelerometer.coeffs() ==
            Eigen::Quaterniond::Identity().coeffs());
    const UncertaintyEstimate estimate = estimateUncertainty(rig.input, solution, {}, RunContext{});
    QCOMPARE(estimate.report.imus[0].gyroscope_rotation_std_rad.norm(), 0.0);
    QCOMPARE(estimate.report.standard_deviations.size(),
             test::reportedErrors(solution.state, rig.truth).size());
    // The misalignment is still reported.
    const QString reason = QString::fromStdString(estimate.turned_gyroscopes);
    QVERIFY2(reason.startsWith("imu: the gyroscope seems misaligned with "), qPrintable(reason));
    const double turn_deg = reason.section("about ", 1, 1).section(' ', 0, 0).toDouble();
    QVERIFY2(std::abs(turn_deg - 0.8) < 0.1, qPrintable(reason));
  }

  void straightGyroscopes_raiseNoDoubt() {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      test::RigOptions options = turnedRig(seed);
      options.gyroscope_turn_rad = 0.0;
      const test::SimulatedRig rig = test::simulateRig(options);
      const BatchSolution solution =
          optimiseBatch(rig.input, test::disturbed(rig.truth, seed), {}, RunContext{});
      const UncertaintyEstimate estimate = estimateUncertainty(rig.input, solution, {}, RunContext{});
      QCOMPARE(QString::fromStdString(estimate.turned_gyroscopes), QString());
      QCOMPARE(QString::fromStdString(estimate.reason), QString());
    }
  }

  // Motion about one axis only: a misalignment about it is not observable, and none is claimed.
  void oneAxisRotation_leavesTheTurnAlone() {
    test::RigOptions options = turnedRig();
    options.motion = test::Motion::OneAxisRotation;
    const test::SimulatedRig rig = test::simulateRig(options);
    const BatchSolution solution =
        optimiseBatch(rig.input, test::disturbed(rig.truth, 1), withRotation(), RunContext{});
    QVERIFY(solution.state.imus[0].gyroscope_from_accelerometer.coeffs() ==
            Eigen::Quaterniond::Identity().coeffs());
    QVERIFY(std::any_of(solution.notes.begin(), solution.notes.end(), [](const std::string& note) {
      return note.find("misalignment is fixed") != std::string::npos;
    }));
  }
};

}  // namespace

EVICAL_TEST(TestGyroscopeRotation)
#include "tst_gyroscope_rotation.moc"
