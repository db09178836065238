#include "core/geometry/trajectory.h"

#include "core/geometry/so3.h"
#include "tests/support/numeric_jacobian.h"
#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <random>

namespace {

using namespace evical;
using Eigen::Vector3d;

constexpr double kKnot_s = 0.1, kBegin_s = 2.0, kEnd_s = 3.0;

struct Motion {
  So3Spline rotation;
  VectorSpline position;
};

Motion anyMotion() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return test::randomVector<3>([&] { return uniform(random); }); };
  Motion motion{makeUniformSo3Spline(kBegin_s, kEnd_s, kKnot_s, quaternionExp(vector())),
                makeUniformVectorSpline(kBegin_s, kEnd_s, kKnot_s)};
  for (std::size_t k = 1; k < motion.rotation.control_points.size(); ++k)
    motion.rotation.control_points[k] = motion.rotation.control_points[k - 1] * quaternionExp(0.2 * vector());
  for (Vector3d& point : motion.position.control_points) point = 0.3 * vector();
  return motion;
}

// d(value)/dt, for a function of time.
template <class Function>
Vector3d derivative(const Function& value, double time_s) {
  return test::numericJacobian(
      [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return value(time_s + d[0]); }, 1, 1e-3);
}

bool sameForTrajectory(const RigidTransform& one, const RigidTransform& other) {
  return rotationAngleBetween_rad(one.rotation, other.rotation) < 1e-13 &&
         (one.translation_m - other.translation_m).norm() < 1e-13;
}

}  // namespace

class TestTrajectory : public QObject {
  Q_OBJECT

 private slots:
  void atRest_thePoseIsThatOfTheControlPoints() {
    const RigidTransform pose{quaternionExp({0.1, 0.2, -0.3}), {1.0, -2.0, 0.5}};
    const So3Spline rotation = makeUniformSo3Spline(kBegin_s, kEnd_s, kKnot_s, pose.rotation);
    const VectorSpline position = makeUniformVectorSpline(kBegin_s, kEnd_s, kKnot_s, pose.translation_m);
    for (const double time_s : {kBegin_s, 2.345, kEnd_s}) {
      QVERIFY(sameForTrajectory(worldFromImu(rotation, position, time_s), pose));
      const MotionSample motion = motionAt(rotation, position, time_s);
      QVERIFY(sameForTrajectory(motion.world_from_imu, pose));
      for (const Vector3d& rate : {motion.velocity_m_s, motion.acceleration_m_s2,
                                   motion.angular_velocity_rad_s, motion.angular_acceleration_rad_s2})
        QVERIFY(rate.norm() < 1e-11);
    }
  }

  void steadyMotion_hasItsRatesByHand() {
    // Control points move by the same step from knot to knot: 0.2 rad about z and 0.05 m along x in 0.1 s.
    So3Spline rotation = makeUniformSo3Spline(kBegin_s, kEnd_s, kKnot_s);
    VectorSpline position = makeUniformVectorSpline(kBegin_s, kEnd_s, kKnot_s);
    for (std::size_t k = 0; k < rotation.control_points.size(); ++k) {
      const double step = static_cast<double>(k) - 1.0;  // control point 1 weighs most at the begin
      rotation.control_points[k] = quaternionExp({0.0, 0.0, 0.2 * step});
      position.control_points[k] = {0.05 * step, 0.0, 0.0};
    }
    const MotionSample motion = motionAt(rotation, position, kBegin_s + 0.35);
    QVERIFY((motion.velocity_m_s - Vector3d(0.5, 0.0, 0.0)).norm() < 1e-12);
    QVERIFY(motion.acceleration_m_s2.norm() < 1e-10);
    QVERIFY((motion.angular_velocity_rad_s - Vector3d(0.0, 0.0, 2.0)).norm() < 1e-12);
    QVERIFY(motion.angular_acceleration_rad_s2.norm() < 1e-10);
    QVERIFY((motion.world_from_imu.translation_m - Vector3d(0.175, 0.0, 0.0)).norm() < 1e-13);
    QVERIFY((quaternionLog(motion.world_from_imu.rotation) - Vector3d(0.0, 0.0, 0.7)).norm() < 1e-13);
  }

  void rates_areTheDerivativesOfThePose_data() {
    QTest::addColumn<double>("time_s");
    // Differences reach 2 ms to either side, so they are taken within a segment: rates have kinks at knots.
    for (const double time_s : {2.003, 2.05, 2.437, 2.997}) QTest::addRow("%g s", time_s) << time_s;
  }
  void rates_areTheDerivativesOfThePose() {
    QFETCH(double, time_s);
    const Motion m = anyMotion();
    const MotionSample motion = motionAt(m.rotation, m.position, time_s);
    const auto at = [&](double t) { return motionAt(m.rotation, m.position, t); };
    const Eigen::Quaterniond here = motion.world_from_imu.rotation;
    QVERIFY((derivative([&](double t) { return at(t).world_from_imu.translation_m; }, time_s) -
             motion.velocity_m_s)
                .norm() < 1e-9);
    QVERIFY(
        (derivative([&](double t) { return at(t).velocity_m_s; }, time_s) - motion.acceleration_m_s2).norm() <
        1e-8);
    QVERIFY(
        (derivative([&](double t) { return quaternionLog(here.conjugate() * at(t).world_from_imu.rotation); },
                    time_s) -
         motion.angular_velocity_rad_s)
            .norm() < 1e-8);
    QVERIFY((derivative([&](double t) { return at(t).angular_velocity_rad_s; }, time_s) -
             motion.angular_acceleration_rad_s2)
                .norm() < 1e-6);
    QVERIFY(sameForTrajectory(worldFromImu(m.rotation, m.position, time_s), motion.world_from_imu));
  }

  void camera_isWhereItsReferenceCarriesIt() {
    const Motion m = anyMotion();
    const RigidTransform imu_from_camera{quaternionExp({0.4, -1.2, 0.3}), {0.02, -0.05, 0.01}};
    constexpr double kOffset_s = 0.04, kCamera_s = 2.5;  // imu_time = camera_time + offset
    const RigidTransform world_from_camera =
        worldFromImu(m.rotation, m.position, kCamera_s + kOffset_s) * imu_from_camera;
    const RigidTransform camera_from_world =
        cameraFromWorld(m.rotation, m.position, imu_from_camera, kOffset_s, kCamera_s);
    QVERIFY(sameForTrajectory(camera_from_world * world_from_camera, {}));
    QVERIFY((camera_from_world * world_from_camera.translation_m).norm() < 1e-14);
  }
};

EVICAL_TEST(TestTrajectory)
#include "tst_trajectory.moc"
