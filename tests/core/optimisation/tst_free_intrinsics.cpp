// Intrinsics as unknowns of the batch, started at a lens that differs slightly from the true one.
#include "core/data/intrinsics_result.h"
#include "core/data/quantity.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/projection_difference.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/optimisation/uncertainty/prior_check.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <random>

namespace {

using namespace evical;

CameraIntrinsics trueCamera(CameraModel model) {
  CameraIntrinsics camera{model, {346, 260}, {260.0, 260.0}, {173.0, 130.0}, {-0.3, 0.1, 5e-4, -3e-4, 0.0}};
  if (model == CameraModel::PinholeEquidistant) camera.distortion = {-0.03, 0.01, -5e-3, 2e-3, 0.0};
  if (model == CameraModel::Eucm) camera.distortion = {0.63, 1.04, 0.0, 0.0, 0.0};
  if (model == CameraModel::DoubleSphere) {
    camera.focal_length_px *= 0.83;
    camera.distortion = {-0.17, 0.59, 0.0, 0.0, 0.0};
  }
  if (model == CameraModel::OmniRadtan) {
    camera.focal_length_px *= 2.2;
    camera.distortion = {1.2, -0.03, 0.01, 5e-4, -3e-4};
  }
  return camera;
}

CameraIntrinsics roughly(CameraIntrinsics camera, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> off(-1.0, 1.0);
  for (int axis = 0; axis < 2; ++axis) {
    camera.focal_length_px[axis] *= 1.0 + 2e-3 * off(random);
    camera.principal_point_px[axis] += off(random);
  }
  camera.distortion[0] += 5e-3 * off(random);
  camera.distortion[1] += 5e-3 * off(random);
  return camera;
}

test::SimulatedRig rigOfFreeIntrinsics(CameraModel model, const test::RigOptions& options) {
  test::SimulatedRig rig = test::simulateRig(options);
  test::seeThrough(trueCamera(model), roughly(trueCamera(model), options.seed), rig);
  return rig;
}

// Given with errors as large as the given sigmas; both focal lengths have the same error.
test::SimulatedRig rigOfKnownLens(unsigned seed) {
  LensUncertainty uncertainty;
  uncertainty.std << 0.06, 0.06, 0.06, 0.06, 1e-3, 1e-3, 1e-4, 1e-4, 0.0;
  constexpr double kTogether = 0.9;
  uncertainty.correlation = IntrinsicsMatrix::Identity();
  (*uncertainty.correlation)(0, 1) = (*uncertainty.correlation)(1, 0) = kTogether;
  std::mt19937 random(100 + seed);
  std::normal_distribution<double> normal;
  IntrinsicsVector error;
  for (double& each : error) each = normal(random);
  error[1] = kTogether * error[0] + std::sqrt(1.0 - kTogether * kTogether) * error[1];
  const CameraIntrinsics truth = trueCamera(CameraModel::PinholeRadtan);
  std::array<double, 9> numbers{};
  writeIntrinsics(truth, numbers.data());
  for (std::size_t k = 0; k < numbers.size(); ++k)
    numbers[k] += uncertainty.std[static_cast<Eigen::Index>(k)] * error[static_cast<Eigen::Index>(k)];
  const CameraIntrinsics given = intrinsicsFrom(numbers.data(), truth.model, truth.resolution_px);
  test::SimulatedRig rig = test::simulateRig(test::shortRecording(seed));
  test::seeThrough(truth, given, rig);
  rig.input.cameras[0].lens = givenLens(given, uncertainty);
  return rig;
}

BatchSolution solveForFreeIntrinsics(const test::SimulatedRig& rig, unsigned seed,
                                     const OptimisationOptions& options = {}) {
  CalibrationState start = test::disturbed(rig.truth, seed);
  start.cameras[0].lens.solved.reset();
  return optimiseBatch(rig.input, start, options, RunContext{});
}

QString text(double value) {
  return QString::number(value);
}

QString partOfColumn(const UncertaintyReport& report, std::size_t column) {
  return QString::fromStdString(quantityPart(report.columns.at(column)).name);
}

class TestFreeIntrinsics : public QObject {
  Q_OBJECT

 private slots:
  void lens_data() {
    QTest::addColumn<int>("model");
    QTest::newRow("radtan") << static_cast<int>(CameraModel::PinholeRadtan);
    QTest::newRow("equidistant") << static_cast<int>(CameraModel::PinholeEquidistant);
    QTest::newRow("double sphere") << static_cast<int>(CameraModel::DoubleSphere);
    QTest::newRow("eucm") << static_cast<int>(CameraModel::Eucm);
  }

  void batch_onNoiselessData_findsTheTrueLens_data() { lens_data(); }
  void batch_onNoiselessData_findsTheTrueLens() {
    QFETCH(int, model);
    test::RigOptions options = test::shortRecording();
    options.centre_sigma_px = 0.0;
    options.imu_noise = 0.0;
    const test::SimulatedRig rig = rigOfFreeIntrinsics(static_cast<CameraModel>(model), options);
    const CameraIntrinsics& truth = *rig.truth.cameras[0].lens.solved;
    QVERIFY(projectionDifference(truth, *rig.input.cameras[0].lens.detection_intrinsics).rms_px > 0.1);
    OptimisationOptions exact;
    exact.displacement_px = exact.displacement_px2_s = 0.0;  // as in these circles
    const BatchSolution solution = solveForFreeIntrinsics(rig, 1, exact);
    QVERIFY(solution.converged);
    const CameraState &camera = solution.state.cameras[0], &true_camera = rig.truth.cameras[0];
    const double difference_px = projectionDifference(truth, camera.lens.solved.value()).rms_px;
    QVERIFY2(difference_px < 2e-3, qPrintable(text(difference_px)));
    const double focal_px = (idealFocalLength_px(*camera.lens.solved) - idealFocalLength_px(truth)).norm();
    QVERIFY2(focal_px < 0.02, qPrintable(text(focal_px)));
    QVERIFY(rotationAngleBetween_rad(camera.reference_from_camera.rotation,
                                     true_camera.reference_from_camera.rotation) < 5e-5);
    QVERIFY((camera.reference_from_camera.translation_m - true_camera.reference_from_camera.translation_m)
                .norm() < 3e-4);
    const double offset_s = std::abs(camera.time_offset_s - true_camera.time_offset_s);
    QVERIFY2(offset_s < 4e-6, qPrintable(text(offset_s)));
    QVERIFY(solution.cameras[0].reprojection_rms_px < 2e-3);
    QCOMPARE(camera.lens.solved->distortion[4], 0.0);
  }

  // 36 quantities over 24 seeds: 7 of the extrinsics, 8 of the intrinsics.
  void sigmas_areHonest_data() { lens_data(); }
  void sigmas_areHonest() {
    QFETCH(int, model);
    constexpr unsigned kSeeds = 24;
    Eigen::VectorXd sum;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig =
          rigOfFreeIntrinsics(static_cast<CameraModel>(model), test::shortRecording(seed));
      const BatchSolution solution = solveForFreeIntrinsics(rig, seed);
      const UncertaintyReport report = estimateUncertainty(rig.input, solution, {}, RunContext{}).report;
      const Eigen::VectorXd normalised =
          test::reportedErrors(solution.state, rig.truth).cwiseQuotient(report.standard_deviations);
      if (seed == 1) sum = Eigen::VectorXd::Zero(normalised.size());
      sum += normalised.cwiseAbs2();
    }
    const Eigen::VectorXd rms = (sum / kSeeds).cwiseSqrt();
    const auto rmsOf = [&](Eigen::Index first, Eigen::Index count) {
      return std::sqrt(rms.segment(first, count).squaredNorm() / static_cast<double>(count));
    };
    const double extrinsics = rmsOf(0, 7),
                 intrinsics = rmsOf(10, 4 + coefficientCount(static_cast<CameraModel>(model))),
                 all = rmsOf(0, rms.size());
    QVERIFY2(extrinsics > 0.7 && extrinsics < 1.4, qPrintable(text(extrinsics)));
    QVERIFY2(intrinsics > 0.7 && intrinsics < 1.4, qPrintable(text(intrinsics)));
    QVERIFY2(all > 0.8 && all < 1.25, qPrintable(text(all)));
  }

  void report_namesThemWithTheirSigmas() {
    const test::SimulatedRig rig = rigOfFreeIntrinsics(CameraModel::PinholeRadtan, test::shortRecording());
    const BatchSolution solution = solveForFreeIntrinsics(rig, 1);
    const UncertaintyEstimate estimate = estimateUncertainty(rig.input, solution, {}, RunContext{});
    const UncertaintyReport& report = estimate.report;
    QCOMPARE(partOfColumn(report, 10), QString("focal_length.x"));
    QCOMPARE(partOfColumn(report, 13), QString("principal_point.y"));
    QCOMPARE(partOfColumn(report, 16), QString("distortion.p1"));
    QVERIFY((report.columns[10] == QuantityAddress{QuantityOwner::Camera, 0, QuantityId::Intrinsics, 0,
                                                   CameraModel::PinholeRadtan}));
    QVERIFY((report.columns[18] == QuantityAddress{QuantityOwner::Imu, 0, QuantityId::GyroscopeBias}));
    QCOMPARE(report.columns.size(), static_cast<std::size_t>(report.correlation.rows()));
    const std::array<double, 9>& sigmas = report.cameras[0].intrinsics_std.value();
    for (std::size_t k = 0; k < 8; ++k)
      QCOMPARE(sigmas[k], report.standard_deviations[10 + static_cast<Eigen::Index>(k)]);
    QCOMPARE(sigmas[8], 0.0);
    QVERIFY2(sigmas[0] > 0.005 && sigmas[0] < 1.0, qPrintable(text(sigmas[0])));
    QCOMPARE(report.observability.size(), std::size_t{7});  // the extrinsics' alone
  }

  void extrinsicSigmas_holdThoseOfTheLens() {
    const CameraIntrinsics truth = trueCamera(CameraModel::PinholeRadtan);
    test::RigOptions recording = test::shortRecording();
    recording.duration_s = 6.0;  // with less, the residuals' correlation is poorly known, and sigmas scatter
    test::SimulatedRig rig = test::simulateRig(recording);
    test::seeThrough(truth, truth, rig);
    const UncertaintyReport free =
        estimateUncertainty(rig.input, solveForFreeIntrinsics(rig, 1), {}, RunContext{}).report;
    OptimisationOptions options;
    options.camera_intrinsics = CameraIntrinsicsChoice::Fixed;
    const BatchSolution fixed = solveForFreeIntrinsics(rig, 1, options);
    QVERIFY(!fixed.state.cameras[0].lens.solved);
    const UncertaintyReport held = estimateUncertainty(rig.input, fixed, options, RunContext{}).report;
    QVERIFY(!held.cameras[0].intrinsics_std);
    QCOMPARE(held.columns.size() + 8, free.columns.size());
    const CameraUncertainty &with = free.cameras[0], &without = held.cameras[0];
    QVERIFY(with.rotation_std_rad.norm() > without.rotation_std_rad.norm());
    QVERIFY(with.translation_std_m.norm() > without.translation_std_m.norm());
  }

  void found_areHeldWhereAsked() {
    const test::SimulatedRig rig = rigOfFreeIntrinsics(CameraModel::PinholeRadtan, test::shortRecording());
    OptimisationOptions options;
    options.camera_intrinsics = CameraIntrinsicsChoice::Fixed;
    QVERIFY(!solveForFreeIntrinsics(rig, 1, options).state.cameras[0].lens.solved);
  }

  void givenIntrinsics_areSolvedFor_withinTheirPrior() {
    test::SimulatedRig rig = rigOfFreeIntrinsics(CameraModel::PinholeRadtan, test::shortRecording());
    rig.input.cameras[0].lens.given = rig.input.cameras[0].lens.detection_intrinsics;
    OptimisationOptions options;
    const CameraIntrinsics &given = *rig.input.cameras[0].lens.detection_intrinsics,
                           &truth = *rig.truth.cameras[0].lens.solved;
    const double before_px = projectionDifference(truth, given).rms_px;
    const double after_px =
        projectionDifference(truth,
                             solveForFreeIntrinsics(rig, 1, options).state.cameras[0].lens.solved.value())
            .rms_px;
    QVERIFY2(after_px < 0.2 * before_px, qPrintable(text(after_px / before_px)));
    options.camera_focal_length_sigma = 1e-6;
    options.camera_principal_point_sigma_px = 1e-4;
    options.camera_distortion_sigma = 1e-6;
    const double held_px =
        projectionDifference(given,
                             solveForFreeIntrinsics(rig, 1, options).state.cameras[0].lens.solved.value())
            .rms_px;
    QVERIFY2(held_px < 0.01, qPrintable(text(held_px)));
  }

  // Intrinsics from a file with sigmas: the result is at least as accurate, more accurate than without them,
  // and its errors agree with its sigmas.
  void statedSigmas_weighInTheBatch() {
    constexpr unsigned kSeeds = 8;
    double sum = 0.0, count = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig = rigOfKnownLens(seed);
      const BatchSolution solution = solveForFreeIntrinsics(rig, seed);
      const UncertaintyReport report = estimateUncertainty(rig.input, solution, {}, RunContext{}).report;
      const std::array<double, 9> sigmas = report.cameras[0].intrinsics_std.value();
      const IntrinsicsVector& stated = rig.input.cameras[0].lens.given_with->std;
      for (int k = 0; k < 8; ++k)
        QVERIFY2(sigmas[static_cast<std::size_t>(k)] < 1.05 * stated[k],
                 qPrintable(text(sigmas[static_cast<std::size_t>(k)])));
      const Eigen::VectorXd normalised =
          test::reportedErrors(solution.state, rig.truth).cwiseQuotient(report.standard_deviations);
      sum += normalised.squaredNorm();
      count += static_cast<double>(normalised.size());
      if (seed > 1) continue;
      test::SimulatedRig weak = rig;
      weak.input.cameras[0].lens.given_with.reset();
      const BatchSolution by_weak = solveForFreeIntrinsics(weak, seed);
      const UncertaintyReport weak_report = estimateUncertainty(weak.input, by_weak, {}, RunContext{}).report;
      QVERIFY2(sigmas[0] < 0.8 * weak_report.cameras[0].intrinsics_std.value()[0],
               qPrintable(text(sigmas[0] / weak_report.cameras[0].intrinsics_std.value()[0])));
    }
    const double rms = std::sqrt(sum / count);
    QVERIFY2(rms > 0.7 && rms < 1.3, qPrintable(text(rms)));
  }

  // A lens that was rotated since its file was written.
  void statedSigmas_thatContradictTheRecording_areDoubted() {
    test::SimulatedRig rig = rigOfKnownLens(1);
    const BatchSolution right = solveForFreeIntrinsics(rig, 1);
    const std::string none = checkPriors(rig.input, right, {}, RunContext{}).doubt;
    QVERIFY2(none.empty(), none.c_str());
    const auto uncertainty = rig.input.cameras[0].lens.given_with;
    const CameraIntrinsics truth = trueCamera(CameraModel::PinholeRadtan);
    CameraIntrinsics wrong = truth;
    wrong.focal_length_px *= 1.03;
    rig = test::simulateRig(test::shortRecording(1));
    test::seeThrough(truth, wrong, rig);
    rig.input.cameras[0].lens = givenLens(wrong, uncertainty);
    const QString doubt = QString::fromStdString(
        checkPriors(rig.input, solveForFreeIntrinsics(rig, 1), {}, RunContext{}).doubt);
    QVERIFY2(doubt.startsWith("left.focal_length"), qPrintable(doubt));
  }

  // Without correlations, no more is claimed than correlated sigmas of that size allow.
  void sigmasWithoutCorrelations_countDoubled() {
    LensUncertainty uncertainty;
    uncertainty.std.head<2>().setConstant(0.5);
    QCOMPARE(uncertainty.covariance()(0, 0), 1.0);
    uncertainty.correlation = IntrinsicsMatrix::Identity();
    (*uncertainty.correlation)(0, 1) = (*uncertainty.correlation)(1, 0) = 0.9;
    QCOMPARE(uncertainty.covariance()(0, 1), 0.9 * 0.25);
    QCOMPARE(uncertainty.covariance()(2, 2), 0.0);
  }

  // Rao's score test: a fixed quantity is tested nevertheless, and named.
  void heldLensThatIsWrong_isDoubted() {
    test::SimulatedRig rig = test::simulateRig(test::shortRecording());
    const CameraIntrinsics given = *rig.input.cameras[0].lens.given;
    OptimisationOptions options;
    options.camera_intrinsics = CameraIntrinsicsChoice::Fixed;
    const auto qualityWarningOf = [&](const CameraIntrinsics& lens) {
      rig.input.cameras[0].lens = givenLens(lens);
      return estimateUncertainty(rig.input, solveForFreeIntrinsics(rig, 1, options), options, RunContext{})
          .wrong_lenses;
    };
    QCOMPARE(qualityWarningOf(given), std::string());
    CameraIntrinsics longer = given, aside = given;
    longer.focal_length_px *= 1.01;
    aside.principal_point_px.x() += 2.0;
    const QString by_length = QString::fromStdString(qualityWarningOf(longer));
    QVERIFY2(by_length.contains("left: the lens differs from the session's: focal lengths by -"),
             qPrintable(by_length));
    const QString by_centre = QString::fromStdString(qualityWarningOf(aside));
    QVERIFY2(by_centre.contains("principal point by (-"), qPrintable(by_centre));
    QVERIFY(by_centre.contains("optimisation.model.camera_intrinsics: free"));
  }

  void k3_isSolvedForWhereItIsUsed() {
    test::SimulatedRig rig = test::simulateRig(test::shortRecording());
    CameraIntrinsics truth = trueCamera(CameraModel::PinholeRadtan), seen = roughly(truth, 1);
    truth.distortion[4] = 0.02;
    seen.distortion[4] = 0.01;
    test::seeThrough(truth, seen, rig);
    OptimisationOptions options;
    options.board_bow = false;  // with it, this lens of 3 s has an error of 0.059 px
    const BatchSolution solution = solveForFreeIntrinsics(rig, 1, options);
    QVERIFY(solution.state.cameras[0].lens.solved->distortion[4] != 0.01);
    const UncertaintyReport report = estimateUncertainty(rig.input, solution, options, RunContext{}).report;
    QCOMPARE(partOfColumn(report, 18), QString("distortion.k3"));
    const double off_px = projectionDifference(truth, *solution.state.cameras[0].lens.solved).rms_px;
    QVERIFY2(off_px < 0.05, qPrintable(text(off_px)));
  }

  void lastStage_releasesThem_whicheverItIs() {
    const test::SimulatedRig rig = rigOfFreeIntrinsics(CameraModel::PinholeRadtan, test::shortRecording());
    const CameraIntrinsics& seen = *rig.input.cameras[0].lens.detection_intrinsics;
    OptimisationOptions options;
    options.free_imu_intrinsics = false;
    const BatchSolution without = solveForFreeIntrinsics(rig, 1, options);
    QVERIFY(projectionDifference(seen, without.state.cameras[0].lens.solved.value()).rms_px > 0.1);
    QVERIFY(without.state.imus[0].gyroscope_scale_misalignment == Eigen::Matrix3d::Identity());
    const BatchSolution solution = solveForFreeIntrinsics(rig, 1);
    for (const IterationRecord& iteration : solution.iterations)
      if (iteration.stage == 1) QVERIFY(*iteration.cameras[0].lens.solved == seen);
  }
};

}  // namespace

EVICAL_TEST(TestFreeIntrinsics)
#include "tst_free_intrinsics.moc"
