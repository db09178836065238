#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/circle_errors.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/optimisation/circle_errors.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <QElapsedTimer>

namespace {

using namespace evical;

test::RigOptions noiseless() {
  test::RigOptions options;
  options.duration_s = 4.0;
  options.imu_rate_hz = 200.0;
  options.centre_sigma_px = 0.0;
  options.imu_noise = 0.0;
  return options;
}

test::RigOptions noisy() {
  test::RigOptions options;
  options.duration_s = 4.0;
  options.imu_rate_hz = 200.0;
  return options;
}

double rotationError_deg(const CameraState& a, const CameraState& b) {
  return rotationAngleBetween_rad(a.reference_from_camera.rotation, b.reference_from_camera.rotation) *
         180.0 / M_PI;
}
double translationError_mm(const CameraState& a, const CameraState& b) {
  return 1e3 * (a.reference_from_camera.translation_m - b.reference_from_camera.translation_m).norm();
}
// At the time of one of the two, since clocks drift.
double offsetError_ms(const CameraState& a, const CameraState& b) {
  return 1e3 * std::abs(a.time_offset_s - timeOffsetAt_s(b, a.time_offset_at_s));
}

// Requests a stop at the first progress message.
class StopOnProgress : public ProgressSink {
 public:
  void stageStarted(const ProgressStage&) override {}
  void stageProgress(double fraction) override {
    fractions.push_back(fraction);
    source.request_stop();
    since_stop.start();
  }
  void log(LogLevel, std::string_view) override {}

  std::stop_source source;
  QElapsedTimer since_stop;
  std::vector<double> fractions;
};

class KeepProgress : public ProgressSink {
 public:
  void stageStarted(const ProgressStage&) override {}
  void stageProgress(double fraction) override { fractions.push_back(fraction); }
  void log(LogLevel, std::string_view) override {}
  std::vector<double> fractions;
};

class TestBatchOptimiser : public QObject {
  Q_OBJECT

 private slots:
  // A recording ends anywhere between two knots: the lack of information there must not count as noise.
  void lastSegment_ofWhichLittleIsMeasured_spoilsNoWeights() {
    test::SimulatedRig rig = test::simulateRig(noisy());
    CalibrationState state = test::disturbed(rig.truth, 1);
    const double knot_s = state.imu_in_world_m.knot_spacing_s;
    const double end_s = state.imu_in_world_m.start_s + 150.3 * knot_s;
    constexpr std::size_t kControlPoints = 151 + 3;
    state.imu_in_world_m.control_points.resize(kControlPoints);
    state.world_from_imu_rotation.control_points.resize(kControlPoints);
    for (std::size_t k = kControlPoints - 3; k < kControlPoints; ++k)
      state.imu_in_world_m.control_points[k] += Eigen::Vector3d(0.01, 0.0, 0.0);  // as a start may leave it
    std::erase_if(rig.input.imus[0].samples, [&](const ImuSample& sample) {
      return secondsSince(rig.input.start_ns, sample.time_ns) > end_s;
    });
    std::erase_if(rig.input.cameras[0].observations.views,
                  [&](const BoardView& view) { return view.time_s > end_s - 2.0 * knot_s; });
    const BatchSolution solution = optimiseBatch(rig.input, state, {}, RunContext{});
    QVERIFY2(solution.scales.accelerometers[0] > 0.7 && solution.scales.accelerometers[0] < 1.1,
             QByteArray::number(solution.scales.accelerometers[0]));
    QVERIFY(translationError_mm(solution.state.cameras[0], rig.truth.cameras[0]) < 5.0);
  }

  // The remaining error is the difference between cubic splines with these knots and sinusoids.
  void batch_onNoiselessData_recoversTruth() {
    const test::SimulatedRig rig = test::simulateRig(noiseless());
    OptimisationOptions options;  // the scale is known: its priors also affect the mapping
    options.free_board_size = options.free_gravity_norm = false;
    options.displacement_px = options.displacement_px2_s = 0.0;  // as in these circles
    const BatchSolution solution =
        optimiseBatch(rig.input, test::disturbed(rig.truth, 1), options, RunContext{});
    const CameraState &camera = solution.state.cameras[0], &true_camera = rig.truth.cameras[0];
    QVERIFY(solution.converged);
    QVERIFY(rotationError_deg(camera, true_camera) < 1e-3);
    QVERIFY(translationError_mm(camera, true_camera) < 0.1);
    QVERIFY2(offsetError_ms(camera, true_camera) < 4e-3,  // the accelerometer's delay costs 0.01 ms
             qPrintable(QString::number(offsetError_ms(camera, true_camera))));
    QVERIFY(std::abs(camera.edge_localisation_bias_px - true_camera.edge_localisation_bias_px) < 1e-3);
    const ImuState &imu = solution.state.imus[0], &true_imu = rig.truth.imus[0];
    QVERIFY((imu.gyroscope_bias_rad_s - true_imu.gyroscope_bias_rad_s).norm() < 1e-5);
    QVERIFY((imu.accelerometer_bias_m_s2 - true_imu.accelerometer_bias_m_s2).norm() < 2e-3);
    QVERIFY((imu.gyroscope_scale_misalignment - true_imu.gyroscope_scale_misalignment).norm() < 1e-4);
    QVERIFY((imu.accelerometer_scale_misalignment - true_imu.accelerometer_scale_misalignment).norm() < 2e-4);
    QVERIFY((solution.state.gravity_in_world_m_s2 - rig.truth.gravity_in_world_m_s2).norm() < 2e-3);
    QVERIFY(std::abs(solution.state.gravity_in_world_m_s2.norm() - 9.81) < 1e-9);
    QVERIFY(solution.cameras[0].reprojection_rms_px < 1e-3);
  }

  void batch_ofTwoImus_recoversBoth() {
    test::RigOptions options = noiseless();
    options.second_imu = true;
    const test::SimulatedRig rig = test::simulateRig(options);
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    const ImuState &imu = solution.state.imus[1], &truth = rig.truth.imus[1];
    QVERIFY(rotationAngleBetween_rad(imu.reference_from_imu.rotation, truth.reference_from_imu.rotation) <
            2e-5);
    QVERIFY((imu.reference_from_imu.translation_m - truth.reference_from_imu.translation_m).norm() < 2e-4);
    QVERIFY(std::abs(imu.time_offset_s - truth.time_offset_s) < 2e-6);
    QVERIFY(translationError_mm(solution.state.cameras[0], rig.truth.cameras[0]) < 0.1);
  }

  void batch_withNoise_reachesItsSigmas() {
    const test::SimulatedRig rig = test::simulateRig(noisy());
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    QVERIFY(rotationError_deg(solution.state.cameras[0], rig.truth.cameras[0]) < 0.08);
    QVERIFY(translationError_mm(solution.state.cameras[0], rig.truth.cameras[0]) < 2.5);
    const double offset_ms = offsetError_ms(solution.state.cameras[0], rig.truth.cameras[0]);
    QVERIFY2(offset_ms < 0.13, qPrintable(QString::number(offset_ms)));
    QVERIFY(std::abs(solution.cameras[0].normalised_rms - 1.0) < 0.1);
    QVERIFY(std::abs(solution.scales.circles[0] - 1.0) < 0.1);
    QCOMPARE(solution.cameras[0].windows_used,
             static_cast<int>(rig.input.cameras[0].observations.views.size()));
    QCOMPARE(
        circleResiduals(rig.input, solution.circle_errors, solution.used_circles).size(),
        static_cast<std::size_t>(solution.cameras[0].circles_used + solution.cameras[0].circles_rejected));
    QVERIFY(!solution.iterations.empty());
    QCOMPARE(solution.iterations.front().cameras.size(), std::size_t{1});
  }

  // A fiftieth of a sigma: the optimum does not depend on the offset's start value.
  void optimum_doesNotDependOnTheStartingOffset() {
    const test::SimulatedRig rig = test::simulateRig(noisy());
    std::vector<CameraState> found;
    for (const double error_s : {0.0, 0.02, -0.02, 0.0073}) {
      const CalibrationState start = test::disturbed(rig.truth, 1, error_s);
      found.push_back(optimiseBatch(rig.input, start, {}, RunContext{}).state.cameras[0]);
    }
    for (const CameraState& camera : found) {
      QVERIFY2(offsetError_ms(camera, found[0]) < 5e-4,
               qPrintable(QString::number(offsetError_ms(camera, found[0]))));
      QVERIFY(translationError_mm(camera, found[0]) < 0.01);
      QVERIFY(rotationError_deg(camera, found[0]) < 5e-4);
    }
  }

  void outliers_areDroppedAndCounted() {
    test::RigOptions options = noisy();
    options.outlier_share = 0.05;
    const test::SimulatedRig rig = test::simulateRig(options);
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    const CameraFit& fit = solution.cameras[0];
    const double share =
        static_cast<double>(fit.circles_rejected) / (fit.circles_rejected + fit.circles_used);
    QVERIFY2(share > 0.045 && share < 0.06, qPrintable(QString::number(share)));
    QVERIFY(translationError_mm(solution.state.cameras[0], rig.truth.cameras[0]) < 2.5);
    QVERIFY(std::abs(solution.scales.circles[0] - 1.0) < 0.15);
  }

  void windowsOfWrongCircles_areDroppedWhole() {
    test::SimulatedRig rig = test::simulateRig(noisy());
    auto& circles = rig.input.cameras[0].observations.views[50].circles;
    const std::size_t wrong = circles.size() * 2 / 3;
    for (std::size_t i = 0; i < wrong; ++i) circles[i].centre_px.x() += 20.0;
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    for (const auto used : solution.used_circles[0][50]) QCOMPARE(int{used}, 0);
    QCOMPARE(solution.cameras[0].windows_used,
             static_cast<int>(rig.input.cameras[0].observations.views.size()) - 1);
  }

  // Wrong noise densities must not change the balance between camera and IMU.
  void wrongNoise_isFoundAndSaid() {
    test::SimulatedRig rig = test::simulateRig(noisy());
    rig.input.imus[0].noise.gyroscope_density *= 10.0;
    for (BoardView& view : rig.input.cameras[0].observations.views) {
      for (CircleObservation& circle : view.circles) circle.covariance_px2 *= 0.04;
    }
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    // Of 5: the lower bound of the centres' sigma accounts for the rest.
    QVERIFY(std::abs(solution.scales.circles[0] - 3.5) < 0.4);
    QVERIFY(std::abs(solution.scales.gyroscopes[0] - 0.09) < 0.02);
    QVERIFY(solution.notes.size() >= 2);
    QVERIFY(translationError_mm(solution.state.cameras[0], rig.truth.cameras[0]) < 2.5);
  }

  void imuIntrinsics_heldBack_stayAsTheyAre() {
    const test::SimulatedRig rig = test::simulateRig(noisy());
    OptimisationOptions options;
    options.free_imu_intrinsics = false;
    const BatchSolution solution =
        optimiseBatch(rig.input, test::disturbed(rig.truth, 1), options, RunContext{});
    QVERIFY(solution.state.imus[0].gyroscope_scale_misalignment == Eigen::Matrix3d::Identity());
  }

  void progress_risesToOne() {
    const test::SimulatedRig rig = test::simulateRig(noisy());
    KeepProgress progress;
    optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{progress, {}});
    QVERIFY(std::is_sorted(progress.fractions.begin(), progress.fractions.end()));
    QVERIFY(progress.fractions.back() > 0.99 && progress.fractions.back() <= 1.0);
  }

  void stop_cancelsWithinHalfASecond() {
    test::RigOptions options = noisy();
    options.duration_s = 20.0;
    const test::SimulatedRig rig = test::simulateRig(options);
    StopOnProgress progress;
    const RunContext context{progress, progress.source.get_token()};
    QVERIFY_THROWS_EXCEPTION(Cancelled, optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, context));
    QVERIFY(progress.since_stop.elapsed() < 500);
    QCOMPARE(progress.fractions.size(), std::size_t{1});
  }

  void noOverlapInTime_saysSo() {
    test::SimulatedRig rig = test::simulateRig(noisy());
    CalibrationState start = test::disturbed(rig.truth, 1);
    start.cameras[0].time_offset_s = 100.0;
    QVERIFY_THROWS_EXCEPTION(CalibrationError, optimiseBatch(rig.input, start, {}, RunContext{}));
  }

  void motionThatLeavesDirectionsOpen_doesNotCrash_data() {
    QTest::addColumn<int>("motion");
    QTest::newRow("one axis") << static_cast<int>(test::Motion::OneAxisRotation);
    QTest::newRow("planar") << static_cast<int>(test::Motion::Planar);
    QTest::newRow("hardly moving") << static_cast<int>(test::Motion::HardlyMoving);
  }
  void motionThatLeavesDirectionsOpen_doesNotCrash() {
    QFETCH(int, motion);
    test::RigOptions options = noisy();
    options.motion = static_cast<test::Motion>(motion);
    const test::SimulatedRig rig = test::simulateRig(options);
    const BatchSolution solution = optimiseBatch(rig.input, test::disturbed(rig.truth, 1), {}, RunContext{});
    QVERIFY(solution.state.cameras[0].reference_from_camera.translation_m.allFinite());
    QVERIFY(solution.cameras[0].reprojection_rms_px < 0.1);
  }
};

}  // namespace

EVICAL_TEST(TestBatchOptimiser)
#include "tst_batch_optimiser.moc"
