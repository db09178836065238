// Biases that walk while the recording runs.
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/sample_errors.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <ceres/crs_matrix.h>
#include <Eigen/Dense>

namespace {

using namespace evical;

test::RigOptions walkingRig(unsigned seed = 1) {
  test::RigOptions options;
  options.duration_s = 8.0;
  options.imu_rate_hz = 200.0;
  options.window_s = 0.04;
  options.gyroscope_walk = 1e-3;
  options.accelerometer_walk = 1e-2;
  options.seed = seed;
  return options;
}

OptimisationOptions linear() {
  OptimisationOptions options;
  options.bias_model = BiasModel::Linear;
  options.bias_knot_spacing_s = 1.0;
  return options;
}

struct BiasDriftRun {
  BatchSolution solution;
  Eigen::VectorXd errors;
  UncertaintyReport report;

  double normalised2(Eigen::Index first, Eigen::Index count) const {
    return errors.cwiseQuotient(report.standard_deviations).segment(first, count).squaredNorm();
  }
};
BiasDriftRun calibrateForBiasDrift(const test::SimulatedRig& rig, unsigned seed,
                                   const OptimisationOptions& options) {
  BiasDriftRun run;
  run.solution = optimiseBatch(rig.input, test::disturbed(rig.truth, seed), options, RunContext{});
  run.errors = test::reportedErrors(run.solution.state, rig.truth);
  run.report = estimateUncertainty(rig.input, run.solution, options, RunContext{}).report;
  return run;
}

class TestBiasDrift : public QObject {
  Q_OBJECT

 private slots:
  void drift_isStraightBetweenKnots() {
    ImuState imu;
    imu.gyroscope_bias_rad_s = {1.0, 0.0, 0.0};
    imu.bias_drift = {10.0, 2.0, {{0.1, 0, 0}, {0.3, 0, 0}, {-0.7, 0, 0}}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}};
    QCOMPARE(imu.gyroscopeBiasAt_rad_s(11.0).x(), 1.2);
    QCOMPARE(imu.gyroscopeBiasAt_rad_s(12.0).x(), 1.3);
    QCOMPARE(imu.gyroscopeBiasAt_rad_s(13.5).x(), 0.55);
    QCOMPARE(imu.accelerometerBiasAt_m_s2(13.0).y(), 0.5);
    // Constant before and after.
    QCOMPARE(imu.gyroscopeBiasAt_rad_s(-5.0).x(), 1.1);
    QCOMPARE(imu.gyroscopeBiasAt_rad_s(99.0).x(), 0.3);
    QVERIFY(std::abs(imu.bias_drift.weight(0) + imu.bias_drift.weight(1) + imu.bias_drift.weight(2) - 1.0) <
            1e-15);
  }

  void constantBiases_stayConstant() {
    const test::SimulatedRig rig = test::simulateRig(walkingRig());
    CalibrationState start = rig.truth;
    start.imus[0].bias_drift = {0.0, 4.0, std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Ones()),
                                std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Ones())};
    CalibrationProblem problem(rig.input, {}, start);
    problem.build(ParameterStages::Mappings, givenWeights(rig.input));
    QVERIFY(problem.driftBlocks().empty());
    QCOMPARE(problem.state().imus[0].bias_drift.knots(), std::size_t{0});
  }

  void longRecordings_haveFewKnots() {
    So3Spline trajectory{0.0, 1.0, std::vector<Eigen::Quaterniond>(3003, Eigen::Quaterniond::Identity())};
    OptimisationOptions options = linear();
    ImuState imu;
    placeBiasKnots(options, {}, trajectory, imu);
    QCOMPARE(imu.bias_drift.knots(), std::size_t{48});
    QVERIFY(std::abs(imu.bias_drift.knotTime_s(47) - 3000.0) < 1e-9);
    options.bias_knot_spacing_s = 1e4;
    options.gyroscope_random_walk = options.accelerometer_random_walk = 1e-8;
    imu.bias_drift = {};
    placeBiasKnots(options, {}, trajectory, imu);
    QCOMPARE(imu.bias_drift.knots(), std::size_t{2});
    // A second of this random walk equals a second's noise.
    trajectory.control_points.resize(13);
    options.gyroscope_random_walk = ImuNoise{}.gyroscope_density;
    imu.bias_drift = {};
    placeBiasKnots(options, {}, trajectory, imu);
    QCOMPARE(imu.bias_drift.knots(), std::size_t{11});
  }

  // Splines and knots eliminated sequentially, and both at once.
  void projectedInformation_isTheSchurComplement() {
    test::RigOptions options = walkingRig();
    options.duration_s = 0.6;
    options.second_imu = true;
    const test::SimulatedRig rig = test::simulateRig(options);
    OptimisationOptions optimisation = linear();
    optimisation.bias_knot_spacing_s = 0.25;
    CalibrationProblem problem(rig.input, optimisation, rig.truth);
    problem.build(ParameterStages::Mappings, givenWeights(rig.input));
    const ProjectedInformation information = projectInformation(problem, 0.1);

    ceres::Problem::EvaluateOptions evaluate;
    evaluate.parameter_blocks = problem.splineBlocks();
    for (const Quantity& knot : problem.driftBlocks()) evaluate.parameter_blocks.push_back(knot.block);
    for (const Quantity& quantity : problem.quantities()) evaluate.parameter_blocks.push_back(quantity.block);
    ceres::CRSMatrix sparse;
    problem.problem().Evaluate(evaluate, nullptr, nullptr, nullptr, &sparse);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    for (int row = 0; row < sparse.num_rows; ++row)
      for (int k = sparse.rows[static_cast<std::size_t>(row)];
           k < sparse.rows[static_cast<std::size_t>(row) + 1]; ++k)
        jacobian(row, sparse.cols[static_cast<std::size_t>(k)]) = sparse.values[static_cast<std::size_t>(k)];
    const Eigen::Index size = information.total.rows();
    const Eigen::VectorXd unit = jacobian.colwise().norm().cwiseMax(1e-9).cwiseInverse();
    const Eigen::MatrixXd scaled = jacobian * unit.asDiagonal();
    const Eigen::MatrixXd normal = scaled.transpose() * scaled;
    const Eigen::Index others = normal.rows() - size;
    const Eigen::MatrixXd schur =
        normal.bottomRightCorner(size, size) -
        normal.bottomLeftCorner(size, others) *
            normal.topLeftCorner(others, others).ldlt().solve(normal.topRightCorner(others, size));
    const Eigen::MatrixXd total =
        unit.tail(size).asDiagonal() * information.total * unit.tail(size).asDiagonal();
    const Eigen::VectorXd scale = schur.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd difference = scale.asDiagonal() * (total - schur) * scale.asDiagonal();
    QVERIFY2(difference.cwiseAbs().maxCoeff() < 1e-4,
             qPrintable(QString::number(difference.cwiseAbs().maxCoeff())));
  }

  // Order of the report: camera 10 (extrinsics 7), biases 6, and the other quantities.
  void walkingBiases_areFollowedWithHonestSigmas() {
    constexpr unsigned kSeeds = 8;
    double extrinsics2 = 0.0, biases2 = 0.0, all2 = 0.0, constant2 = 0.0;
    double translation2 = 0.0, constant_translation2 = 0.0;
    OptimisationOptions options;
    options.bias_model = BiasModel::Linear;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig = test::simulateRig(walkingRig(seed));
      const BiasDriftRun with = calibrateForBiasDrift(rig, seed, options),
                         without = calibrateForBiasDrift(rig, seed, {});
      extrinsics2 += with.normalised2(0, 7) / 7.0;
      biases2 += with.normalised2(10, 6) / 6.0;
      const Eigen::Index count = with.errors.size();
      all2 += with.normalised2(0, count) / static_cast<double>(count);
      constant2 += without.normalised2(0, count) / static_cast<double>(count);
      translation2 += with.errors.segment<3>(3).squaredNorm();
      constant_translation2 += without.errors.segment<3>(3).squaredNorm();
      QVERIFY(sampleErrors(rig.input, with.solution.state, 0).gyroscope_rms_rad_s <
              sampleErrors(rig.input, without.solution.state, 0).gyroscope_rms_rad_s);
    }
    const auto rms = [](double sum2) { return std::sqrt(sum2 / kSeeds); };
    qInfo("normalised errors: extrinsics %.2f, mean biases %.2f, all %.2f; with constant biases, all %.2f",
          rms(extrinsics2), rms(biases2), rms(all2), rms(constant2));
    QVERIFY(rms(extrinsics2) > 0.7 && rms(extrinsics2) < 1.35);
    QVERIFY(rms(biases2) > 0.6 && rms(biases2) < 1.4);
    QVERIFY(rms(all2) > 0.8 && rms(all2) < 1.2);
    QVERIFY(translation2 < 0.5 * constant_translation2);
  }

  void report_knowsEveryKnot() {
    test::RigOptions options = walkingRig();
    options.second_imu = true;
    test::SimulatedRig rig = test::simulateRig(options);
    for (ImuData& imu : rig.input.imus)
      imu.noise.gyroscope_random_walk = imu.noise.accelerometer_random_walk = 0.0;  // not known
    const BiasDriftRun run = calibrateForBiasDrift(rig, 1, linear());
    QCOMPARE(run.report.standard_deviations.size(), run.errors.size());
    for (std::size_t i = 0; i < 2; ++i) {
      const BiasDrift& drift = run.solution.state.imus[i].bias_drift;
      const ImuUncertainty& sigma = run.report.imus[i];
      QCOMPARE(drift.knots(), std::size_t{9});
      QCOMPARE(sigma.gyroscope_drift_std_rad_s.size(), drift.knots());
      QCOMPARE(sigma.accelerometer_drift_std_m_s2.size(), drift.knots());
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < drift.knots(); ++k) {
        mean += drift.weight(k) * drift.gyroscope_rad_s[k];
        // The walk is assumed slow here, so that one time is about as certain as the mean over all.
        QVERIFY((sigma.gyroscope_drift_std_rad_s[k].array() > 0.5 * sigma.gyroscope_bias_std_rad_s.array())
                    .all());
        QVERIFY((sigma.gyroscope_drift_std_rad_s[k].array() < 3e-3).all());
      }
      QVERIFY(mean.norm() < 1e-8);
    }
  }
};

}  // namespace

EVICAL_TEST(TestBiasDrift)
#include "tst_bias_drift.moc"
