#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/initialisation_options.h"
#include "core/numerics/angles.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

std::optional<RelativeRotation> handEyeOf(const SimulatedInput& simulated, double start_offset_s) {
  const auto found = estimateCameraPoses(simulated.input.cameras[0], simulated.input.board, {});
  return estimateCameraImuRotation(found.poses,
                                   GyroRotation(simulated.input.imus[0].samples, simulated.input.start_ns),
                                   start_offset_s, {});
}

}  // namespace

class TestCameraImuRotation : public QObject {
  Q_OBJECT

 private slots:
  void estimate_recoversTruth_data() {
    QTest::addColumn<double>("imu_rate_hz");
    QTest::addColumn<double>("start_error_s");
    QTest::addColumn<double>("missing_share");
    QTest::newRow("1000 Hz, 10 ms early") << 1000.0 << -0.01 << 0.0;
    QTest::newRow("1000 Hz, 50 ms late") << 1000.0 << 0.05 << 0.0;
    QTest::newRow("200 Hz, 40 % missing") << 200.0 << 0.02 << 0.4;
  }
  void estimate_recoversTruth() {
    QFETCH(double, imu_rate_hz);
    QFETCH(double, start_error_s);
    QFETCH(double, missing_share);
    SimulationOptions simulation;
    simulation.duration_s = 20.0;
    simulation.imu_rate_hz = imu_rate_hz;
    simulation.missing_share = missing_share;
    const SimulatedInput simulated = simulateInput(simulation);
    const auto hand_eye = handEyeOf(simulated, simulation.time_offset_s + start_error_s);
    QVERIFY(hand_eye.has_value());
    const double error_rad = rotationAngleBetween_rad(hand_eye->reference_from_sensor,
                                                      simulated.truth.cameras[0].imu_from_camera.rotation);
    QVERIFY2(error_rad < 0.3 * kRadPerDeg, qPrintable(QString::number(error_rad)));
    QVERIFY(std::abs(hand_eye->time_offset_s - simulation.time_offset_s) < 2e-3);
    QVERIFY((hand_eye->gyroscope_bias_rad_s - simulated.truth.imus[0].gyroscope_bias_rad_s).norm() < 3e-3);
    QVERIFY(hand_eye->axis_ratio > 0.3);
  }

  void estimate_onOneAxis_saysSo() {
    SimulationOptions simulation;
    simulation.duration_s = 10.0;
    simulation.motion = Motion::OneAxis;
    const SimulatedInput simulated = simulateInput(simulation);
    const auto hand_eye = handEyeOf(simulated, simulation.time_offset_s);
    QVERIFY(hand_eye.has_value());
    QVERIFY(hand_eye->axis_ratio < InitialisationOptions().min_axis_ratio);
    // The simulated camera rotates about its own y axis.
    const Eigen::Vector3d axis =
        simulated.truth.cameras[0].imu_from_camera.rotation * Eigen::Vector3d::UnitX();
    QVERIFY(std::abs(axis.dot(hand_eye->main_axis_in_imu)) > 0.999 ||
            std::abs((simulated.truth.cameras[0].imu_from_camera.rotation * Eigen::Vector3d::UnitY())
                         .dot(hand_eye->main_axis_in_imu)) > 0.999);
  }

  void estimate_onTooFewPairs_givesNothing() {
    SimulationOptions simulation;
    simulation.duration_s = 0.15;
    QVERIFY(!handEyeOf(simulateInput(simulation), 0.0).has_value());
  }
};

EVICAL_TEST(TestCameraImuRotation)
#include "tst_camera_imu_rotation.moc"
