#include "core/optimisation/uncertainty/covariance.h"

#include "core/geometry/so3.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/imu_simulator.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <ceres/crs_matrix.h>
#include <Eigen/Dense>

#include <random>

namespace {

using namespace evical;

struct CovarianceRun {
  test::SimulatedRig rig;
  BatchSolution solution;
  UncertaintyEstimate estimate;
};
CovarianceRun calibrateForCovariance(const test::RigOptions& options) {
  CovarianceRun run;
  run.rig = test::simulateRig(options);
  run.solution = optimiseBatch(run.rig.input, test::disturbed(run.rig.truth, options.seed), {}, RunContext{});
  run.estimate = estimateUncertainty(run.rig.input, run.solution, {}, RunContext{});
  return run;
}

// Root mean square of error / sigma over seeds, per quantity. A few seconds hardly determine a clock's drift,
// so its prior must be true.
Eigen::VectorXd normalisedErrors(test::RigOptions options, unsigned seeds) {
  Eigen::VectorXd sum;
  std::mt19937_64 generator(20260103);
  std::normal_distribution<double> drift_ppm(0.0, OptimisationOptions{}.time_offset_drift_sigma_ppm);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    options.seed = seed;
    options.time_offset_drift_ppm = drift_ppm(generator);
    const CovarianceRun run = calibrateForCovariance(options);
    const Eigen::VectorXd errors = test::reportedErrors(run.solution.state, run.rig.truth)
                                       .cwiseQuotient(run.estimate.report.standard_deviations);
    if (seed == 1) sum = Eigen::VectorXd::Zero(errors.size());
    sum += errors.cwiseAbs2();
  }
  return (sum / seeds).cwiseSqrt();
}

// The simulator's scenario, without its events: circles of an ideal front end, with noise.
test::SimulatedRig scenarioRig() {
  Scenario scenario;
  scenario.duration_s = 6.0;
  SimulatedCamera camera;
  camera.name = "left";
  camera.intrinsics = {
      CameraModel::PinholeRadtan, {346, 260}, {260.0, 260.0}, {173.0, 130.0}, {-0.3, 0.1, 0.0, 0.0, 0.0}};
  camera.imu_from_camera = {quaternionExp({1.2, -1.2, 1.2}), {0.04, -0.03, 0.05}};
  camera.time_offset_s = 0.005;
  scenario.cameras = {camera};
  SimulatedImu imu;
  imu.rate_hz = 200.0;
  imu.gyroscope_bias_rad_s = {0.01, -0.02, 0.005};
  imu.accelerometer_bias_m_s2 = {0.1, 0.05, -0.08};
  scenario.imus = {imu};

  test::SimulatedRig rig;
  rig.input.start_ns = scenario.start_ns;
  rig.input.board = scenario.board;
  rig.input.cameras = {{"left", givenLens(camera.intrinsics), simulateObservations(scenario, 0, 0.05, 0.02)}};
  rig.input.imus = {{"imu", {}, simulateImu(scenario, 0)}};
  const double begin_s = rig.input.cameras[0].observations.views.front().time_s - 0.02;
  const double end_s = rig.input.cameras[0].observations.views.back().time_s + 0.03;
  std::vector<double> times_s;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Eigen::Vector3d> positions_m;
  const SinusoidMotion motion(scenario);
  for (double t = begin_s; t <= end_s; t += 0.005) {
    const RigidTransform world_from_imu = motion.imuAt(t).world_from_body;
    times_s.push_back(t);
    rotations.push_back(world_from_imu.rotation);
    positions_m.push_back(world_from_imu.translation_m);
  }
  rig.truth.world_from_imu_rotation = fitSo3Spline(times_s, rotations, begin_s, end_s, 0.02);
  rig.truth.imu_in_world_m = fitVectorSpline(times_s, positions_m, begin_s, end_s, 0.02);
  // Stamps are late by the pixels' delay, and so is the resulting offset.
  rig.truth.cameras = {{camera.imu_from_camera, camera.time_offset_s - camera.pixel.delay_s(), 0.0}};
  rig.truth.cameras[0].lens.solved = camera.intrinsics;
  rig.truth.imus.resize(1);
  rig.truth.imus[0].gyroscope_bias_rad_s = imu.gyroscope_bias_rad_s;
  rig.truth.imus[0].accelerometer_bias_m_s2 = imu.accelerometer_bias_m_s2;
  rig.truth.gravity_in_world_m_s2 = scenario.gravity_in_world_m_s2;
  return rig;
}

class TestCovariance : public QObject {
  Q_OBJECT

 private slots:
  // P^T P must be the Schur complement of the dense normal equations.
  void projectedInformation_isTheSchurComplement() {
    test::RigOptions options = test::shortRecording();
    options.duration_s = 0.4;
    const test::SimulatedRig rig = test::simulateRig(options);
    const OptimisationOptions optimisation;
    CalibrationProblem problem(rig.input, optimisation, rig.truth);
    problem.build(ParameterStages::Mappings, givenWeights(rig.input));
    const ProjectedInformation information = projectInformation(problem, 0.1);

    ceres::Problem::EvaluateOptions evaluate;
    evaluate.parameter_blocks = problem.splineBlocks();
    const auto quantities = problem.quantities();
    for (const Quantity& quantity : quantities) evaluate.parameter_blocks.push_back(quantity.block);
    ceres::CRSMatrix sparse;
    problem.problem().Evaluate(evaluate, nullptr, nullptr, nullptr, &sparse);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    for (int row = 0; row < sparse.num_rows; ++row) {
      for (int k = sparse.rows[static_cast<std::size_t>(row)];
           k < sparse.rows[static_cast<std::size_t>(row) + 1]; ++k) {
        jacobian(row, sparse.cols[static_cast<std::size_t>(k)]) = sparse.values[static_cast<std::size_t>(k)];
      }
    }
    const Eigen::Index size = information.total.rows();
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    const Eigen::Index splines = normal.rows() - size;
    const Eigen::MatrixXd schur =
        normal.bottomRightCorner(size, size) -
        normal.bottomLeftCorner(size, splines) *
            normal.topLeftCorner(splines, splines).ldlt().solve(normal.topRightCorner(splines, size));
    const Eigen::VectorXd scale = schur.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd difference = scale.asDiagonal() * (information.total - schur) * scale.asDiagonal();
    QVERIFY2(difference.cwiseAbs().maxCoeff() < 1e-5,
             qPrintable(QString::number(difference.cwiseAbs().maxCoeff())));
  }

  void report_isComplete() {
    test::RigOptions options = test::shortRecording();
    options.second_imu = true;
    const CovarianceRun run = calibrateForCovariance(options);
    const UncertaintyReport& report = run.estimate.report;
    QCOMPARE(report.standard_deviations.size(), test::reportedErrors(run.rig.truth, run.rig.truth).size());
    QCOMPARE(report.columns.size(), static_cast<std::size_t>(report.standard_deviations.size()));
    QCOMPARE(report.correlation.rows(), report.standard_deviations.size());
    QVERIFY(report.standard_deviations.minCoeff() > 0.0);
    QVERIFY((report.correlation - report.correlation.transpose()).norm() < 1e-9);
    QVERIFY(report.correlation.cwiseAbs().maxCoeff() <= 1.0 + 1e-9);
    QVERIFY((report.columns[0] == QuantityAddress{QuantityOwner::Camera, 0, QuantityId::Rotation}));
    QCOMPARE(report.cameras[0].rotation_std_rad, Eigen::Vector3d(report.standard_deviations.head<3>()));
    QCOMPARE(report.cameras[0].time_offset_std_s, report.standard_deviations[6]);
    QVERIFY(report.imus[1].translation_std_m.minCoeff() > 0.0);
    QVERIFY(report.imus[0].gyroscope_scale_misalignment_std(0, 2) > 0.0 &&
            report.imus[0].gyroscope_scale_misalignment_std(2, 0) == 0.0);
    QVERIFY(report.gravity_direction_std_rad > 0.0);
    QCOMPARE(report.observability.size(), std::size_t{14});
    QVERIFY(std::is_sorted(report.observability.begin(), report.observability.end()));
    QVERIFY(!report.weakest.empty());
    QCOMPARE(report.directions.size(), report.observability.size());
    QCOMPARE(report.directions.front(), report.weakest);
  }

  // The claim of docs/maths.md, 10.1. 41 quantities over 20 seeds: their joint RMS is accurate to about 5 %,
  // each one's to 16 %.
  void sigmas_areHonest() {
    test::RigOptions options = test::shortRecording();
    options.scale_spread = 1.0;
    const Eigen::VectorXd rms = normalisedErrors(options, 20);
    const double common = std::sqrt(rms.squaredNorm() / static_cast<double>(rms.size()));
    QVERIFY2(common > 0.85 && common < 1.18, qPrintable(QString::number(common)));
    const double extrinsics = std::sqrt(rms.head<7>().squaredNorm() / 7.0);
    QVERIFY2(extrinsics > 0.75 && extrinsics < 1.3, qPrintable(QString::number(extrinsics)));
    for (const double each : rms) QVERIFY2(each > 0.5 && each < 1.6, qPrintable(QString::number(each)));
  }

  // Centre errors that persist for 0.1 s: their effect must be in the sigmas.
  void sigmas_allowForCorrelatedCentres() {
    test::RigOptions options = test::shortRecording();
    options.window_s = 0.02;
    options.centre_correlation_s = 0.1;
    options.scale_spread = 1.0;
    const Eigen::VectorXd rms = normalisedErrors(options, 10);
    const double extrinsics = std::sqrt(rms.head<7>().squaredNorm() / 7.0);
    QVERIFY2(extrinsics > 0.7 && extrinsics < 1.5, qPrintable(QString::number(extrinsics)));
  }

  void simulatedScenario_isFoundWithinItsSigmas() {
    const test::SimulatedRig rig = scenarioRig();
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    const UncertaintyEstimate estimate = estimateUncertainty(rig.input, solution, {}, RunContext{});
    const Eigen::VectorXd normalised =
        test::reportedErrors(solution.state, rig.truth).cwiseQuotient(estimate.report.standard_deviations);
    QVERIFY2(normalised.cwiseAbs().maxCoeff() < 4.0,
             qPrintable(QString::number(normalised.cwiseAbs().maxCoeff())));
    const double largest_m = estimate.report.cameras[0].translation_std_m.maxCoeff();
    QVERIFY2(largest_m < 2.5e-3, qPrintable(QString::number(largest_m)));
    QVERIFY(estimate.report.cameras[0].time_offset_std_s < 1e-4);
  }

  void richMotion_isOk() {
    test::RigOptions options = test::shortRecording();
    options.duration_s = 8.0;
    const CovarianceRun run = calibrateForCovariance(options);
    QCOMPARE(run.estimate.status, CalibrationStatus::Ok);
    QVERIFY(run.estimate.reason.empty());
    QVERIFY(run.estimate.report.observability.front() > 1.0);
  }

  void poorMotion_isDoubtfulAndNamesTheDirection_data() {
    QTest::addColumn<int>("motion");
    QTest::addColumn<QString>("weakest");
    QTest::newRow("one axis") << static_cast<int>(test::Motion::OneAxisRotation)
                              << "translation along the camera's z axis";
    QTest::newRow("planar") << static_cast<int>(test::Motion::Planar)
                            << "translation along the camera's z axis";
    QTest::newRow("hardly moving") << static_cast<int>(test::Motion::HardlyMoving) << "";
  }
  void poorMotion_isDoubtfulAndNamesTheDirection() {
    QFETCH(int, motion);
    QFETCH(QString, weakest);
    test::RigOptions options = test::shortRecording();
    options.motion = static_cast<test::Motion>(motion);
    const CovarianceRun run = calibrateForCovariance(options);
    QCOMPARE(run.estimate.status, CalibrationStatus::Doubtful);
    QVERIFY(run.estimate.report.standard_deviations.allFinite());
    QVERIFY(run.estimate.report.observability.front() < 1.0);
    const QString named = QString::fromStdString(run.estimate.report.weakest);
    QVERIFY2(named.contains(weakest), qPrintable(named));
    QVERIFY(QString::fromStdString(run.estimate.reason).contains("Record again"));
  }
};

}  // namespace

EVICAL_TEST(TestCovariance)
#include "tst_covariance.moc"
