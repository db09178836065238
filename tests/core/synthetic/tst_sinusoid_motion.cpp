#include "core/geometry/so3.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/core/synthetic/scenarios.h"
#include "tests/support/test_program.h"

using namespace evical;

namespace {

constexpr double kStep_s = 1e-5;  // central differences: error of order step^2 times the third derivative

Eigen::Vector3d rate(const Eigen::Quaterniond& before, const Eigen::Quaterniond& after) {
  return quaternionLog(before.conjugate() * after) / (2.0 * kStep_s);
}

void checkDerivatives(const std::function<MotionState(double)>& stateAt) {
  for (const double t : {0.0, 0.123, 0.777, 3.3, 17.9}) {
    const MotionState now = stateAt(t), before = stateAt(t - kStep_s), after = stateAt(t + kStep_s);
    const Eigen::Vector3d velocity =
        (after.world_from_body.translation_m - before.world_from_body.translation_m) / (2.0 * kStep_s);
    const Eigen::Vector3d acceleration =
        (after.velocity_in_world_m_s - before.velocity_in_world_m_s) / (2.0 * kStep_s);
    const Eigen::Vector3d turn =
        (after.angular_velocity_in_body_rad_s - before.angular_velocity_in_body_rad_s) / (2.0 * kStep_s);
    QVERIFY((velocity - now.velocity_in_world_m_s).norm() < 1e-7);
    QVERIFY((acceleration - now.acceleration_in_world_m_s2).norm() < 1e-6);
    QVERIFY((rate(before.world_from_body.rotation, after.world_from_body.rotation) -
             now.angular_velocity_in_body_rad_s)
                .norm() < 1e-7);
    QVERIFY((turn - now.angular_acceleration_in_body_rad_s2).norm() < 1e-6);
    QVERIFY(now.acceleration_in_world_m_s2.norm() > 0.05);  // it does move
  }
}

}  // namespace

class TestSinusoidMotion : public QObject {
  Q_OBJECT
 private slots:
  void imu_derivativesMatchNumericDifferences() {
    const SinusoidMotion motion(test::wavedScenario());
    checkDerivatives([&](double t) { return motion.imuAt(t); });
  }
  void camera_derivativesMatchNumericDifferences() {
    const SinusoidMotion motion(test::wavedScenario());
    checkDerivatives([&](double t) { return motion.cameraAt(0, t); });
  }
  void turns_derivativesMatchNumericDifferences() {
    Scenario scenario = test::wavedScenario();
    scenario.motion.turn_rad = -0.4;
    scenario.motion.turn_amplitude_rad = 0.6;
    const SinusoidMotion motion(scenario);
    checkDerivatives([&](double t) { return motion.imuAt(t); });
    checkDerivatives([&](double t) { return motion.cameraAt(0, t); });
  }
  void hands_derivativesMatchNumericDifferences() {
    Scenario scenario = test::wavedScenario();
    scenario.motion.hand = {.tremor_rad = 0.0003,
                            .tremor_m = 0.0003,
                            .jerks_per_s = 2.0,
                            .jerk_rad = 0.01,
                            .stop_every_s = 2.0,
                            .stop_s = 0.5,
                            .walking_m = 0.01};
    const SinusoidMotion motion(scenario);
    checkDerivatives([&](double t) { return motion.imuAt(t); });
  }
  // Every two seconds: from 1.25 s a ramp down, from 1.5 s still, from 1.75 s a ramp up.
  void stops_holdTheMotionUp() {
    Scenario scenario = test::wavedScenario();
    const SinusoidMotion without(scenario);
    scenario.motion.hand.stop_every_s = 2.0;
    scenario.motion.hand.stop_s = 0.25;
    const SinusoidMotion with(scenario);
    const auto distance_m = [](const RigidTransform& a, const RigidTransform& b) {
      return (a.translation_m - b.translation_m).norm();
    };
    QVERIFY(distance_m(with.worldFromCamera(0, 1.2), without.worldFromCamera(0, 1.2)) < 1e-12);
    QVERIFY(distance_m(with.worldFromCamera(0, 1.51), with.worldFromCamera(0, 1.74)) < 1e-12);
    QVERIFY(with.imuAt(1.6).angular_velocity_in_body_rad_s.norm() < 1e-12);
    // A stop and two ramps of half the speed reduce the motion by half a second.
    QVERIFY(distance_m(with.worldFromCamera(0, 2.3), without.worldFromCamera(0, 1.8)) < 1e-12);
  }
  void turns_keepTheCameraWhereItIs() {
    Scenario scenario = test::wavedScenario();
    scenario.motion.image_speed_px_s = 0.0;
    const SinusoidMotion plain(scenario);
    scenario.motion.turn_amplitude_rad = 0.6;
    const SinusoidMotion turning(scenario);
    const double time_s = 0.25 * scenario.motion.turn_period_s;
    const RigidTransform before = plain.worldFromCamera(0, time_s),
                         after = turning.worldFromCamera(0, time_s);
    QVERIFY((before.translation_m - after.translation_m).norm() < 1e-12);
    QVERIFY(std::abs(rotationAngleBetween_rad(before.rotation, after.rotation) - 0.6) < 1e-9);
  }
  void camera_isTheImuTimesTheExtrinsics() {
    const Scenario scenario = test::wavedScenario();
    const SinusoidMotion motion(scenario);
    const RigidTransform direct = motion.worldFromCamera(0, 1.7);
    const RigidTransform chained = motion.imuAt(1.7).world_from_body * scenario.cameras[0].imu_from_camera;
    QVERIFY((direct.translation_m - chained.translation_m).norm() < 1e-12);
    QVERIFY(rotationAngleBetween_rad(direct.rotation, chained.rotation) < 1e-7);
  }
  void camera_looksAtTheBoardFromInFront() {
    const Scenario scenario = test::wavedScenario();
    const SinusoidMotion motion(scenario);
    for (double t = 0.0; t < 20.0; t += 0.37) {
      const RigidTransform world_from_camera = motion.worldFromCamera(0, t);
      QVERIFY(world_from_camera.translation_m.z() < -0.2);  // z points into the board
      QVERIFY((world_from_camera.rotation * Eigen::Vector3d::UnitZ()).z() > 0.6);
    }
  }
  void imageSpeed_isReached() {
    Scenario scenario = test::wavedScenario();
    scenario.duration_s = 20.0;
    for (const double speed : {20.0, 70.0, 300.0}) {
      scenario.motion.image_speed_px_s = speed;
      // Frequencies are scaled, so the averaged times differ.
      QVERIFY(std::abs(SinusoidMotion(scenario).imageSpeedRms_px_s() / speed - 1.0) < 0.15);
    }
  }
  void seed_changesTheMotion() {
    Scenario scenario = test::wavedScenario();
    const SinusoidMotion first(scenario), same(scenario);
    scenario.seed += 1;
    const SinusoidMotion other(scenario);
    const auto place = [](const SinusoidMotion& m) { return m.imuAt(0.5).world_from_body.translation_m; };
    QCOMPARE((place(first) - place(same)).norm(), 0.0);
    QVERIFY((place(first) - place(other)).norm() > 1e-3);
  }
};

EVICAL_TEST(TestSinusoidMotion)
#include "tst_sinusoid_motion.moc"
