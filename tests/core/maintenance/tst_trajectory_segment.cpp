// An accelerometer against a trajectory: errors and sigmas over seeds, for any orientation of the world's
// axes; lever arms; gaps; rotation of the poses against a gyroscope.
#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/maintenance/trajectory_segment.h"
#include "core/synthetic/drive_simulator.h"
#include "core/synthetic/random.h"
#include "tests/core/maintenance/drive_data.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

Eigen::Vector3d normalVectorForTrajectoryLag(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

// The trajectory in a rotated world, of a point at a lever arm from the IMU.
std::vector<TimedPose> poses(const DriveScenario& scenario,
                             const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity(),
                             const Eigen::Vector3d& imu_from_point_m = Eigen::Vector3d::Zero()) {
  const DriveMotionModel motion(scenario);
  Random random(scenario.seed, 99);
  std::vector<TimedPose> all;
  for (int k = 0; k < scenario.duration_s * scenario.trajectory_hz; ++k) {
    const double time_s = k / scenario.trajectory_hz;
    const RigidTransform pose = motion.at(time_s).world_from_body;
    const Eigen::Vector3d place =
        pose * imu_from_point_m + scenario.trajectory_noise_m * normalVectorForTrajectoryLag(random);
    all.push_back({time_s, turned * place,
                   turned * pose.rotation *
                       quaternionExp(scenario.trajectory_noise_rad * normalVectorForTrajectoryLag(random))});
  }
  return all;
}

std::vector<LagEstimate> lagsOf(const DriveScenario& scenario, std::vector<TimedPose> all) {
  TrajectorySegment lags(std::move(all), scenario.imus.front(), scenario.gravity_m_s2,
                         scenario.imus.front().accelerometer_density, MaintenanceOptions());
  for (const ImuSample& sample : simulateDriveImu(scenario, 0))
    lags.add(secondsSince(scenario.start_ns, sample.time_ns), sample);
  lags.finish();
  return lags.lags();
}

}  // namespace

class TestTrajectoryLag : public QObject {
  Q_OBJECT

 private slots:
  void pieces_giveBiasesAndScalesWithinSigmas_data() {
    QTest::addColumn<double>("delay_s");
    QTest::newRow("both sensors at once") << 0.0;
    QTest::newRow("late accelerometer") << 0.02;
    QTest::newRow("early accelerometer") << -0.02;
  }
  void pieces_giveBiasesAndScalesWithinSigmas() {
    QFETCH(const double, delay_s);
    constexpr int kSeeds = 20;
    double squares = 0.0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      DriveScenario scenario = driveScenario("drive_trajectory", static_cast<std::uint64_t>(seed));
      scenario.imus.front().accelerometer_delay_s = delay_s;
      const auto lags = lagsOf(scenario, poses(scenario));
      QCOMPARE(lags.size(), std::size_t{3});
      const LagSum sum = sumOfLags(lags, accelerometerNumbers(scenario.imus.front()));
      const AccelerometerVector error =
          sum.now - accelerometerNumbers(scenario.imuAt(0, scenario.duration_s));
      QVERIFY(error.head<3>().cwiseAbs().maxCoeff() < 0.02);  // 2 mg
      squares += (error.array().square() / sum.covariance.diagonal().array()).mean();
    }
    const double ratio = std::sqrt(squares / kSeeds);
    QVERIFY2(ratio > 0.7 && ratio < 1.4, qPrintable(QString::number(ratio)));
  }

  void worldsAxes_doNotMatter() {
    const DriveScenario scenario = driveScenario("drive_trajectory");
    const Eigen::Quaterniond turned = quaternionExp({1.0, -0.7, 2.0});
    const auto level = lagsOf(scenario, poses(scenario)), leaning = lagsOf(scenario, poses(scenario, turned));
    QVERIFY((level.front().now - leaning.front().now).cwiseAbs().maxCoeff() < 1e-5);
    const Eigen::Vector3d down = turned * Eigen::Vector3d(0.0, 0.0, -scenario.gravity_m_s2);
    QVERIFY((leaning.front().gravity_m_s2 - down).norm() < 0.02);
  }

  void pointBesideTheImu_isFoundAsLever() {
    const DriveScenario scenario = driveScenario("drive_trajectory");
    const Eigen::Vector3d beside(0.3, -0.1, 0.05);
    for (const LagEstimate& lag : lagsOf(scenario, poses(scenario, Eigen::Quaterniond::Identity(), beside)))
      QVERIFY((lag.lever_m + beside).norm() < 5.0 * lag.lever_sigma_m.norm());
  }

  void gaps_endPieces() {
    const DriveScenario scenario = driveScenario("drive_trajectory");
    std::vector<TimedPose> all = poses(scenario);
    std::erase_if(all, [](const TimedPose& pose) { return pose.time_s > 30.0 && pose.time_s < 33.0; });
    const auto lags = lagsOf(scenario, all);
    QCOMPARE(lags.size(), std::size_t{3});
    QVERIFY(lags.front().to_s <= 30.1);
    QVERIFY(lags[1].from_s >= 33.0);
  }

  void turns_giveTheFrameBetween() {
    const Eigen::Quaterniond imu_from_body = quaternionExp({0.3, 1.0, -0.4});
    std::vector<Eigen::Vector3d> body, imu;
    Random random(5);
    for (int k = 0; k < 200; ++k) {
      body.push_back(normalVectorForTrajectoryLag(random));
      imu.push_back(imu_from_body * body.back() + 0.01 * normalVectorForTrajectoryLag(random));
    }
    const TurnAgreement same = turnAgreement(body, imu);
    QVERIFY(same.imu_from_body.angularDistance(imu_from_body) < 0.005);
    QVERIFY(same.correlation > 0.99);
    for (Eigen::Vector3d& rate : imu) rate = normalVectorForTrajectoryLag(random);
    QVERIFY(turnAgreement(body, imu).correlation < 0.5);
  }
};

EVICAL_TEST(TestTrajectoryLag)
#include "tst_trajectory_segment.moc"
