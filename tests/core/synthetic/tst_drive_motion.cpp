// Simulated drives: rates and accelerations are the derivatives of the pose, the rig is at rest during stops,
// and attitudes cover all directions.
#include "core/geometry/so3.h"
#include "core/synthetic/drive_simulator.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;

namespace {

DriveScenario tumbling() {
  DriveScenario scenario;
  scenario.motion.stops = 12;
  scenario.motion.attitudes = 12;
  scenario.motion.tilt_rad = 3.14159;
  scenario.imus.resize(1);
  return scenario;
}

}  // namespace

class TestDriveMotion : public QObject {
  Q_OBJECT

 private slots:
  void ratesAndAccelerations_matchNumericDerivatives() {
    const DriveMotionModel motion(tumbling());
    constexpr double kStep_s = 1e-4;
    // Never at the borders of the envelope, where the next derivative is discontinuous.
    for (double t = 0.371; t < 115.0; t += 1.73) {
      const MotionState before = motion.at(t - kStep_s), now = motion.at(t), after = motion.at(t + kStep_s);
      const Eigen::Vector3d rate =
          quaternionLog(before.world_from_body.rotation.conjugate() * after.world_from_body.rotation) /
          (2.0 * kStep_s);
      const Eigen::Vector3d turning =
          (after.angular_velocity_in_body_rad_s - before.angular_velocity_in_body_rad_s) / (2.0 * kStep_s);
      const Eigen::Vector3d velocity =
          (after.world_from_body.translation_m - before.world_from_body.translation_m) / (2.0 * kStep_s);
      const Eigen::Vector3d acceleration =
          (after.velocity_in_world_m_s - before.velocity_in_world_m_s) / (2.0 * kStep_s);
      // Error of a difference with a step of 1e-4 s, due to third derivatives.
      QVERIFY((rate - now.angular_velocity_in_body_rad_s).norm() < 1e-5);
      QVERIFY((turning - now.angular_acceleration_in_body_rad_s2).norm() < 1e-4);
      QVERIFY((velocity - now.velocity_in_world_m_s).norm() < 1e-5);
      QVERIFY((acceleration - now.acceleration_in_world_m_s2).norm() < 1e-4);
    }
  }

  void stops_standStill() {
    const DriveMotionModel motion(tumbling());
    for (int stop = 0; stop < 12; ++stop) {
      const MotionState state = motion.at(10.0 * stop + 2.0);
      QCOMPARE(state.angular_velocity_in_body_rad_s.norm(), 0.0);
      QCOMPARE(state.acceleration_in_world_m_s2.norm(), 0.0);
    }
  }

  void attitudes_goAllAround() {
    const DriveMotionModel motion(tumbling());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (int stop = 0; stop < 12; ++stop) {
      const Eigen::Vector3d up =
          motion.at(10.0 * stop + 2.0).world_from_body.rotation.conjugate() * Eigen::Vector3d::UnitZ();
      spread += up * up.transpose() / 12.0;
    }
    QVERIFY(spread.diagonal().minCoeff() > 0.2);
  }
};

EVICAL_TEST(TestDriveMotion)
#include "tst_drive_motion.moc"
