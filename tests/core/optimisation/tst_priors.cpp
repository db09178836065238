// Given and weighted values: errors and reported sigmas against the truth.
#include "core/geometry/so3.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/optimisation/uncertainty/prior_check.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>

namespace {

using namespace evical;
using Eigen::Vector3d;

test::RigOptions shortPriorRecording() {
  test::RigOptions options;
  options.duration_s = 4.0;
  options.imu_rate_hz = 200.0;
  options.window_s = 0.03;
  return options;
}

struct PriorsRun {
  BatchSolution solution;
  UncertaintyEstimate estimate;
  PriorCheck check;
};
PriorsRun calibrateForPriors(const test::SimulatedRig& rig, const OptimisationOptions& options = {}) {
  PriorsRun run;
  CalibrationState start = test::disturbed(rig.truth, 1);
  for (std::size_t i = 0; i < start.imus.size(); ++i)  // like initialisation
    if (const auto& known = rig.input.imus[i].prior.gyroscope_rotation)
      start.imus[i].gyroscope_from_accelerometer = known->value;
  run.solution = optimiseBatch(rig.input, start, options, RunContext{});
  run.estimate = estimateUncertainty(rig.input, run.solution, options, RunContext{});
  run.check = checkPriors(rig.input, run.solution, options, RunContext{});
  return run;
}

bool says(const std::vector<std::string>& texts, const std::string& words) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(words) != std::string::npos; });
}

// Error of the camera's translation along a direction in the reference frame.
double translationSigma_m(const UncertaintyReport& report, const Vector3d& direction) {
  const Eigen::Index first =
      columnOf({QuantityOwner::Camera, 0, QuantityId::Translation}, report.columns).value();
  const Vector3d std = report.standard_deviations.segment<3>(first);
  const Eigen::Matrix3d covariance =
      std.asDiagonal() * report.correlation.block<3, 3>(first, first) * std.asDiagonal();
  return std::sqrt(direction.dot(covariance * direction));
}

Vector3d lever(const CalibrationState& state) {
  return state.cameras[0].reference_from_camera.translation_m;
}

}  // namespace

class TestPriors : public QObject {
  Q_OBJECT

 private slots:
  void withoutPriors_nothingIsSaid() {
    const PriorsRun run = calibrateForPriors(test::simulateRig(shortPriorRecording()));
    QVERIFY(run.check.notes.empty() && run.check.doubt.empty());
    QVERIFY(run.estimate.report.given.empty());
  }

  void timeOffsetGivenAtTheTruth_isHeld() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    const double offset_s = rig.truth.cameras[0].time_offset_s;
    rig.input.cameras[0].prior.time_offset = KnownNumber{offset_s};
    const PriorsRun run = calibrateForPriors(rig);
    QCOMPARE(run.solution.state.cameras[0].time_offset_s, offset_s);
    QCOMPARE(run.estimate.report.cameras[0].time_offset_std_s, 0.0);
    for (const QuantityAddress& column : run.estimate.report.columns)
      QVERIFY(column.id != QuantityId::TimeOffset && column.id != QuantityId::TimeOffsetDrift);
    QCOMPARE(run.estimate.report.given, std::vector<std::string>{"left.time_offset"});
    QCOMPARE(run.check.notes, std::vector<std::string>{"given, not estimated: left.time_offset"});
    QVERIFY(run.check.doubt.empty());
    const Vector3d error_m = lever(run.solution.state) - lever(rig.truth);
    for (int axis = 0; axis < 3; ++axis)
      QVERIFY(std::abs(error_m[axis]) < 4.0 * run.estimate.report.cameras[0].translation_std_m[axis]);
  }

  // If the offset is fixed at 0 although it is not 0, the result must not be ok.
  void timeOffsetsThatAreNotFree_stayAt0AndAreDoubted() {
    test::RigOptions simulation = shortPriorRecording();
    simulation.seed = 3;
    const test::SimulatedRig rig = test::simulateRig(simulation);
    QVERIFY2(std::abs(rig.truth.cameras[0].time_offset_s) > 1e-3,
             qPrintable(QString::number(rig.truth.cameras[0].time_offset_s)));
    OptimisationOptions options;
    options.free_time_offsets = false;
    const PriorsRun run = calibrateForPriors(rig, options);
    QCOMPARE(run.solution.state.cameras[0].time_offset_s, 0.0);
    QCOMPARE(run.estimate.report.given, std::vector<std::string>{"left.time_offset"});
    QVERIFY2(run.check.doubt.find("left.time_offset") != std::string::npos, run.check.doubt.c_str());
  }

  void imuIntrinsicsThatAreNotFree_stayAtTheirPriors() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    const ImuState& truth = rig.truth.imus[0];
    rig.input.imus[0].prior.gyroscope_scale_misalignment = KnownMapping{truth.gyroscope_scale_misalignment};
    rig.input.imus[0].prior.accelerometer_scale_misalignment =
        KnownMapping{truth.accelerometer_scale_misalignment, Eigen::Matrix3d::Constant(0.01)};
    OptimisationOptions options;
    options.free_imu_intrinsics = false;
    const PriorsRun run = calibrateForPriors(rig, options);
    const ImuState& imu = run.solution.state.imus[0];
    QVERIFY(imu.gyroscope_scale_misalignment == truth.gyroscope_scale_misalignment);
    QVERIFY(imu.accelerometer_scale_misalignment == truth.accelerometer_scale_misalignment);
    const ImuUncertainty& sigma = run.estimate.report.imus[0];
    QVERIFY(sigma.gyroscope_scale_misalignment_std.norm() == 0.0 &&
            sigma.accelerometer_scale_misalignment_std.norm() == 0.0);
    QVERIFY(run.check.doubt.empty());
    QCOMPARE(run.check.notes.size(), std::size_t{1});
    const Vector3d bias_error = imu.gyroscope_bias_rad_s - truth.gyroscope_bias_rad_s;
    for (int axis = 0; axis < 3; ++axis) {
      QVERIFY(sigma.gyroscope_bias_std_rad_s[axis] > 0.0);
      QVERIFY(std::abs(bias_error[axis]) < 4.0 * sigma.gyroscope_bias_std_rad_s[axis]);
    }
  }

  // The recording outweighs such a prior; but one of the two is wrong.
  void weighedPriorThatIsFarOff_isDoubted() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    const double truth_s = rig.truth.cameras[0].time_offset_s;
    rig.input.cameras[0].prior.time_offset = KnownNumber{truth_s + 0.02, 1e-3};
    const PriorsRun run = calibrateForPriors(rig, {});
    QVERIFY(std::abs(run.solution.state.cameras[0].time_offset_s - truth_s) < 1e-3);
    QVERIFY2(run.check.doubt.find("left.time_offset") != std::string::npos, run.check.doubt.c_str());
  }

  void mappingsHeldAtTheIdentity_areContradicted() {
    OptimisationOptions options;
    options.free_imu_intrinsics = false;
    const PriorsRun run = calibrateForPriors(test::simulateRig(shortPriorRecording()), options);
    QVERIFY(says(run.check.notes, "imu.gyroscope_scale_misalignment"));
    QVERIFY(run.check.doubt.empty());  // it is not required
  }

  void gravitysNorm_isFoundWhereItIsFree() {
    test::RigOptions simulation = shortPriorRecording();
    simulation.gravity_m_s2 = 9.79;
    test::SimulatedRig rig = test::simulateRig(simulation);
    // Scale and gravity have nearly the same effect on a resting accelerometer.
    rig.input.imus[0].prior.accelerometer_scale_misalignment =
        KnownMapping{rig.truth.imus[0].accelerometer_scale_misalignment};
    OptimisationOptions options;
    options.free_gravity_norm = true;
    CalibrationState start = test::disturbed(rig.truth, 1);
    start.gravity_in_world_m_s2 *= 9.81 / start.gravity_in_world_m_s2.norm();
    const BatchSolution solution = optimiseBatch(rig.input, start, options, RunContext{});
    const UncertaintyEstimate estimate = estimateUncertainty(rig.input, solution, options, RunContext{});
    const double error_m_s2 = solution.state.gravity_in_world_m_s2.norm() - 9.79;
    const double sigma_m_s2 = estimate.report.gravity_norm_std_m_s2;
    QVERIFY2(sigma_m_s2 > 0.0 && sigma_m_s2 < 0.01, qPrintable(QString::number(sigma_m_s2)));
    QVERIFY2(std::abs(error_m_s2) < 3.0 * sigma_m_s2, qPrintable(QString::number(error_m_s2)));
    QVERIFY(
        (estimate.report.columns.back() == QuantityAddress{QuantityOwner::Rig, 0, QuantityId::Gravity, 2}));
    QVERIFY(estimate.report.gravity_direction_std_rad > 0.0);
    QVERIFY(!estimate.report.weakest.empty());
  }

  // If the norm is not separable from the accelerometer's scale and bias, it is the prior's.
  void gravitysNorm_withoutMotion_hasThePriorsSigma() {
    test::RigOptions simulation = shortPriorRecording();
    simulation.motion = test::Motion::HardlyMoving;
    OptimisationOptions options;
    options.free_gravity_norm = true;
    options.gravity_norm_sigma_m_s2 = 0.03;
    const PriorsRun run = calibrateForPriors(test::simulateRig(simulation), options);
    const double sigma_m_s2 = run.estimate.report.gravity_norm_std_m_s2;
    QVERIFY2(std::abs(sigma_m_s2 - 0.03) < 0.005, qPrintable(QString::number(sigma_m_s2)));
    QVERIFY(std::abs(run.solution.state.gravity_in_world_m_s2.norm() - 9.81) < 0.03);
  }

  void weightedPrior_decidesWhatTheMotionLeavesOpen_data() {
    QTest::addColumn<int>("motion");
    QTest::newRow("one axis") << static_cast<int>(test::Motion::OneAxisRotation);
    QTest::newRow("planar") << static_cast<int>(test::Motion::Planar);
  }
  void weightedPrior_decidesWhatTheMotionLeavesOpen() {
    QFETCH(int, motion);
    test::RigOptions simulation = shortPriorRecording();
    simulation.motion = static_cast<test::Motion>(motion);
    test::SimulatedRig rig = test::simulateRig(simulation);
    const Vector3d axis = rig.truth.cameras[0].reference_from_camera.rotation * Vector3d::UnitZ();
    constexpr double kSigma_m = 0.5e-3;
    const Vector3d mean_m = lever(rig.truth) + 0.3e-3 * axis;
    rig.input.cameras[0].prior.translation = KnownVector{mean_m, Vector3d::Constant(kSigma_m)};
    const PriorsRun run = calibrateForPriors(rig);
    const double along_m = axis.dot(lever(run.solution.state) - mean_m);
    QVERIFY2(std::abs(along_m) < 0.1e-3, qPrintable(QString::number(along_m)));
    const double sigma_m = translationSigma_m(run.estimate.report, axis);
    QVERIFY2(sigma_m > 0.85 * kSigma_m && sigma_m < 1.05 * kSigma_m, qPrintable(QString::number(sigma_m)));
    QVERIFY2(run.check.notes.empty(), run.check.notes.empty() ? "" : run.check.notes[0].c_str());
    QVERIFY(run.estimate.reason.find("translation") == std::string::npos);
  }

  void translationGivenAtTheTruth_isHeld() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    rig.input.cameras[0].prior.translation = KnownVector{lever(rig.truth)};
    const PriorsRun run = calibrateForPriors(rig);
    QVERIFY(lever(run.solution.state) == lever(rig.truth));
    QVERIFY(run.estimate.report.cameras[0].translation_std_m.norm() == 0.0);
    QVERIFY(run.check.doubt.empty());
    const double turn_rad =
        rotationAngleBetween_rad(run.solution.state.cameras[0].reference_from_camera.rotation,
                                 rig.truth.cameras[0].reference_from_camera.rotation);
    QVERIFY(turn_rad < 4.0 * run.estimate.report.cameras[0].rotation_std_rad.norm());
  }

  void givenValueThatIsWrong_isDoubted() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    rig.input.cameras[0].prior.translation = KnownVector{lever(rig.truth) + Vector3d(0.02, 0.0, 0.0)};
    const PriorsRun run = calibrateForPriors(rig);
    QVERIFY2(run.check.doubt.find("left.translation x") != std::string::npos, run.check.doubt.c_str());
    QVERIFY(says(run.check.notes, "given as"));
  }

  // The prior is so tight that the solution stays with it, although the recording alone contradicts it.
  void weightedPriorThatIsWrong_isSaid() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    rig.input.cameras[0].prior.translation =
        KnownVector{lever(rig.truth) + Vector3d(0.0, 0.03, 0.0), Vector3d::Constant(1e-4)};
    const PriorsRun tight = calibrateForPriors(rig);
    QVERIFY(says(tight.check.notes, "left.translation y"));
    QVERIFY(tight.check.doubt.find("left.translation y") != std::string::npos);
    rig.input.cameras[0].prior.translation =
        KnownVector{lever(rig.truth) + Vector3d(0.0, 0.03, 0.0), Vector3d::Constant(0.05)};
    const PriorsRun loose = calibrateForPriors(rig);
    QVERIFY(loose.check.notes.empty());
    QVERIFY(std::abs((lever(loose.solution.state) - lever(rig.truth)).y()) <
            4.0 * loose.estimate.report.cameras[0].translation_std_m.y());
  }

  void weightedRotation_isBetterThanEither() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    const PriorsRun alone = calibrateForPriors(rig);
    const Vector3d sigma_rad = alone.estimate.report.cameras[0].rotation_std_rad;
    const Eigen::Quaterniond& truth = rig.truth.cameras[0].reference_from_camera.rotation;
    rig.input.cameras[0].prior.rotation = KnownRotation{quaternionExp(0.5 * sigma_rad) * truth, sigma_rad};
    const PriorsRun run = calibrateForPriors(rig);
    const Vector3d error_rad =
        quaternionLog(run.solution.state.cameras[0].reference_from_camera.rotation * truth.conjugate());
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma = run.estimate.report.cameras[0].rotation_std_rad[axis];
      QVERIFY2(sigma < 0.8 * sigma_rad[axis] && sigma > 0.4 * sigma_rad[axis],
               qPrintable(QString::number(sigma / sigma_rad[axis])));
      QVERIFY(std::abs(error_rad[axis]) < 4.0 * sigma);
    }
  }

  void furtherImu_takesItsPriorsToo() {
    test::RigOptions simulation = shortPriorRecording();
    simulation.second_imu = true;
    test::SimulatedRig rig = test::simulateRig(simulation);
    const ImuState& truth = rig.truth.imus[1];
    ImuPrior& prior = rig.input.imus[1].prior;
    prior.time_offset = KnownNumber{truth.time_offset_s};
    prior.rotation = KnownRotation{truth.reference_from_imu.rotation};
    prior.gyroscope_bias = KnownVector{truth.gyroscope_bias_rad_s, Vector3d::Constant(1e-3)};
    const PriorsRun run = calibrateForPriors(rig);
    const ImuState& imu = run.solution.state.imus[1];
    QCOMPARE(imu.time_offset_s, truth.time_offset_s);
    QVERIFY(imu.reference_from_imu.rotation.coeffs() == truth.reference_from_imu.rotation.coeffs());
    QVERIFY(run.check.doubt.empty());
    const std::vector<std::string> given = {"imu_2.rotation", "imu_2.time_offset"};
    QCOMPARE(run.estimate.report.given, given);
    const Vector3d error_m = imu.reference_from_imu.translation_m - truth.reference_from_imu.translation_m;
    for (int axis = 0; axis < 3; ++axis)
      QVERIFY(std::abs(error_m[axis]) < 4.0 * run.estimate.report.imus[1].translation_std_m[axis]);
  }

  // A known misalignment must be used, given or weighted, and for any value of the option for unknown
  // misalignments.
  void knownGyroscopeRotation_isHeldOrWeighed_data() {
    QTest::addColumn<bool>("option");
    QTest::newRow("not looked for") << false;
    QTest::newRow("looked for") << true;
  }
  void knownGyroscopeRotation_isHeldOrWeighed() {
    QFETCH(bool, option);
    test::RigOptions simulation = shortPriorRecording();
    simulation.gyroscope_turn_rad = 10.0 * M_PI / 180.0;
    test::SimulatedRig rig = test::simulateRig(simulation);
    const Eigen::Quaterniond truth = rig.truth.imus[0].gyroscope_from_accelerometer;
    OptimisationOptions options;
    options.gyroscope_rotation = option ? Estimated::Yes : Estimated::No;
    std::optional<KnownRotation>& prior = rig.input.imus[0].prior.gyroscope_rotation;
    const auto error_rad = [&](const PriorsRun& run) {
      return quaternionLog(truth.conjugate() * run.solution.state.imus[0].gyroscope_from_accelerometer);
    };
    prior = KnownRotation{truth};
    const PriorsRun given = calibrateForPriors(rig, options);
    QVERIFY(error_rad(given).norm() < 1e-12);
    QCOMPARE(given.estimate.report.given, std::vector<std::string>{"imu.gyroscope_rotation"});
    QVERIFY(given.estimate.report.imus[0].gyroscope_rotation_std_rad.norm() == 0.0);
    QVERIFY2(given.check.doubt.empty() && given.estimate.reason.empty(), given.estimate.reason.c_str());
    const Vector3d lever_error_m = lever(given.solution.state) - lever(rig.truth);
    for (int axis = 0; axis < 3; ++axis)
      QVERIFY(std::abs(lever_error_m[axis]) < 4.0 * given.estimate.report.cameras[0].translation_std_m[axis]);

    constexpr double kSigma_rad = 5e-4;
    prior =
        KnownRotation{truth * quaternionExp({kSigma_rad, 0.0, -kSigma_rad}), Vector3d::Constant(kSigma_rad)};
    const PriorsRun weighed = calibrateForPriors(rig, options);
    const Vector3d sigma_rad = weighed.estimate.report.imus[0].gyroscope_rotation_std_rad;
    for (int axis = 0; axis < 3; ++axis) {
      QVERIFY2(sigma_rad[axis] > 0.0 && sigma_rad[axis] < 1.05 * kSigma_rad,
               qPrintable(QString::number(sigma_rad[axis])));
      QVERIFY(std::abs(error_rad(weighed)[axis]) < 4.0 * kSigma_rad);
    }
    QVERIFY(weighed.estimate.report.given.empty() && weighed.check.notes.empty());
  }

  void everythingGiven_leavesNothingToJudge() {
    test::SimulatedRig rig = test::simulateRig(shortPriorRecording());
    const CameraState& truth = rig.truth.cameras[0];
    rig.input.cameras[0].prior = {KnownRotation{truth.reference_from_camera.rotation},
                                  KnownVector{truth.reference_from_camera.translation_m},
                                  KnownNumber{truth.time_offset_s},
                                  {}};
    const PriorsRun run = calibrateForPriors(rig);
    QVERIFY(run.estimate.report.observability.empty());
    QCOMPARE(run.estimate.status, CalibrationStatus::Ok);
    QVERIFY(run.check.doubt.empty());
    QVERIFY(run.estimate.report.standard_deviations.allFinite());
  }
};

EVICAL_TEST(TestPriors)
#include "tst_priors.moc"
