#include "core/initialisation/gravity_alignment.h"

#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <limits>
#include <random>

using namespace evical;
using namespace evical::test;
using Eigen::Vector3d;

namespace {

// True rotations, positions with 2 mm of noise.
struct Truth {
  SimulatedInput simulated;
  CameraTrack track;
  So3Spline rotation;
};

Truth makeTruth(const SimulationOptions& simulation, double knot_spacing_s = 0.02) {
  Truth truth;
  truth.simulated = simulateInput(simulation);
  const SinusoidMotion motion(truth.simulated.truth);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  truth.track.time_offset_s = simulation.time_offset_s;
  for (const BoardView& view : truth.simulated.input.cameras[0].observations.views) {
    CameraPose pose;
    pose.time_s = view.time_s;
    pose.world_from_camera = motion.worldFromCamera(0, view.time_s + simulation.time_offset_s);
    pose.world_from_camera.translation_m += 2e-3 * test::randomVector<3>([&] { return normal(random); });
    truth.track.poses.push_back(pose);
  }
  std::vector<double> times_s;
  std::vector<Eigen::Quaterniond> rotations;
  for (double t = 0.0; t <= simulation.duration_s - 0.01; t += 0.005) {
    times_s.push_back(t);
    rotations.push_back(motion.imuAt(t).world_from_body.rotation);
  }
  truth.rotation = fitSo3Spline(times_s, rotations, 0.0, simulation.duration_s - 0.01, knot_spacing_s);
  return truth;
}

GravityAlignment align(const Truth& truth) {
  return alignGravity({&truth.track, 1}, truth.simulated.input.imus[0].samples,
                      truth.simulated.input.start_ns, truth.rotation, {});
}

double gravityError_rad(const GravityAlignment& found, const Truth& truth) {
  return std::atan2(found.gravity_in_world_m_s2.cross(truth.simulated.truth.gravity_in_world_m_s2).norm(),
                    found.gravity_in_world_m_s2.dot(truth.simulated.truth.gravity_in_world_m_s2));
}

}  // namespace

class TestGravityAlignment : public QObject {
  Q_OBJECT

 private slots:
  void align_recoversTruth_data() {
    QTest::addColumn<double>("imu_rate_hz");
    QTest::addColumn<double>("missing_share");
    QTest::newRow("1000 Hz") << 1000.0 << 0.0;
    QTest::newRow("200 Hz, 40 % missing") << 200.0 << 0.4;
  }
  void align_recoversTruth() {
    QFETCH(double, imu_rate_hz);
    QFETCH(double, missing_share);
    SimulationOptions simulation;
    simulation.duration_s = 15.0;
    simulation.imu_rate_hz = imu_rate_hz;
    simulation.missing_share = missing_share;
    const Truth truth = makeTruth(simulation);
    const GravityAlignment found = align(truth);
    const SimulatedInput& simulated = truth.simulated;
    const Vector3d lever = simulated.truth.cameras[0].imu_from_camera.translation_m;
    QVERIFY((found.cameras_in_imu_m[0] - lever).norm() < 5e-3);
    QVERIFY(gravityError_rad(found, truth) < 0.3 * kRadPerDeg);
    QVERIFY(std::abs(found.gravity_in_world_m_s2.norm() - 9.81) < 1e-9);
    QVERIFY((found.accelerometer_bias_m_s2 - simulated.truth.imus[0].accelerometer_bias_m_s2).norm() < 0.06);
    QCOMPARE(found.outlying_views, 0);
    const SinusoidMotion motion(simulated.truth);
    for (double t = 1.0; t < 14.0; t += 0.31) {
      const Vector3d there = motion.imuAt(t).world_from_body.translation_m;
      QVERIFY((evaluate(found.imu_in_world_m, t).value - there).norm() < 0.01);
    }
  }

  void align_withMisreadBoards_leavesThemOut() {
    SimulationOptions simulation;
    simulation.duration_s = 10.0;
    Truth truth = makeTruth(simulation);
    int misread = 0;
    for (std::size_t k = 3; k < truth.track.poses.size(); k += 20, ++misread)
      truth.track.poses[k].world_from_camera.translation_m += Vector3d(0.05, 0.05, 0.0);
    const GravityAlignment found = align(truth);
    QCOMPARE(found.outlying_views, misread);
    const Vector3d lever = truth.simulated.truth.cameras[0].imu_from_camera.translation_m;
    QVERIFY((found.cameras_in_imu_m[0] - lever).norm() < 5e-3);
  }

  // A board size given 10 % too small makes all distances 10 % too short. Errors of some percent in scales
  // and axes of the accelerometer must not be mistaken for that.
  void align_tellsTheBoardsScale_data() {
    QTest::addColumn<double>("scale");
    QTest::addColumn<bool>("skewed");
    QTest::newRow("right") << 1.0 << false;
    QTest::newRow("given too small") << 1.1 << false;
    QTest::newRow("given too large") << 0.9 << false;
    QTest::newRow("right, accelerometer off") << 1.0 << true;
    QTest::newRow("given too small, accelerometer off") << 1.1 << true;
  }
  void align_tellsTheBoardsScale() {
    QFETCH(double, scale);
    QFETCH(bool, skewed);
    SimulationOptions simulation;
    simulation.duration_s = 10.0;
    Truth truth = makeTruth(simulation);
    for (CameraPose& pose : truth.track.poses) pose.world_from_camera.translation_m /= scale;
    if (skewed) {
      Eigen::Matrix3d mapping;
      mapping << 0.97, -0.02, 0.015, 0.0, 1.035, 0.02, 0.0, 0.0, 0.96;
      for (ImuSample& sample : truth.simulated.input.imus[0].samples)
        sample.specific_force_m_s2 = mapping * sample.specific_force_m_s2;
    }
    const GravityAlignment found = align(truth);
    const QString text = QString("%1 +- %2").arg(found.board_scale).arg(found.board_scale_std);
    QVERIFY2(std::abs(found.board_scale - scale) < 0.015, qPrintable(text));
    QVERIFY2(found.board_scale_std > 1e-4 && found.board_scale_std < 0.01, qPrintable(text));
  }

  // Without a solution of the linear system, the board's scale has no sensitivities either.
  void align_withoutSolution_ends() {
    SimulationOptions simulation;
    simulation.duration_s = 6.0;
    Truth truth = makeTruth(simulation);
    for (ImuSample& sample : truth.simulated.input.imus[0].samples)
      sample.specific_force_m_s2.setConstant(std::numeric_limits<double>::quiet_NaN());
    QCOMPARE(align(truth).cameras_in_imu_m.size(), std::size_t{1});
  }

  // Hardly any motion: the lever arm is unknown, and its estimate must stay small.
  void align_onWeakMotion_doesNotExplode() {
    SimulationOptions simulation;
    simulation.duration_s = 6.0;
    simulation.motion = Motion::HardlyMoving;
    const GravityAlignment found = align(makeTruth(simulation));
    QVERIFY(found.cameras_in_imu_m[0].norm() < 0.5);
    QVERIFY(found.accelerometer_bias_m_s2.norm() < 1.0);
    QVERIFY(found.board_scale_std > 0.02);
  }

  // Rotation about one axis does not determine the camera's angle about it; accelerations do.
  void findTurn_undoesTurn_data() {
    QTest::addColumn<double>("turn_rad");
    QTest::newRow("none") << 0.0;
    QTest::newRow("1 rad") << 1.0;
    QTest::newRow("-2.5 rad") << -2.5;
  }
  void findTurn_undoesTurn() {
    QFETCH(double, turn_rad);
    SimulationOptions simulation;
    simulation.duration_s = 8.0;
    simulation.motion = Motion::OneAxis;
    Truth truth = makeTruth(simulation, 0.05);
    const SinusoidMotion motion(truth.simulated.truth);
    const Vector3d axis = motion.imuAt(1.0).angular_velocity_in_body_rad_s.normalized();
    for (auto& point : truth.rotation.control_points) point = point * quaternionExp(turn_rad * axis);
    const double found = findTurnAboutAxis(axis, {&truth.track, 1}, truth.simulated.input.imus[0].samples,
                                           truth.simulated.input.start_ns, truth.rotation, {});
    QVERIFY2(std::abs(std::remainder(found + turn_rad, 2.0 * M_PI)) < 0.03,
             qPrintable(QString::number(found)));
  }
};

EVICAL_TEST(TestGravityAlignment)
#include "tst_gravity_alignment.moc"
