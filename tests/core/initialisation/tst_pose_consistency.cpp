#include "core/initialisation/camera_alignment.h"

#include "core/geometry/so3.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

// The second pose of a plane that looks nearly the same from far away: tilted the other way relative to the
// line of sight.
RigidTransform mirrored(const RigidTransform& world_from_camera) {
  const Eigen::Vector3d sight = (world_from_camera.rotation * Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  const double tilt = std::acos(std::clamp(sight.dot(normal), -1.0, 1.0));
  const Eigen::Vector3d axis = sight.cross(normal).normalized();
  RigidTransform other = world_from_camera;
  other.rotation = quaternionExp(2.0 * tilt * axis) * world_from_camera.rotation;
  return other;
}

struct Prepared {
  SimulatedInput simulated;
  std::vector<CameraPose> poses;
  RelativeRotation hand_eye;
};

Prepared prepare() {
  Prepared p;
  SimulationOptions options;
  options.duration_s = 8.0;
  options.time_offset_s = 0.3;
  p.simulated = simulateInput(options);
  p.poses = estimateCameraPoses(p.simulated.input.cameras[0], p.simulated.input.board, {}).poses;
  // An error of one degree, as in a first hand-eye estimate.
  p.hand_eye.reference_from_sensor =
      p.simulated.truth.cameras[0].imu_from_camera.rotation * quaternionExp({0.01, -0.012, 0.008});
  p.hand_eye.time_offset_s = 0.301;
  return p;
}

GyroRotation gyroOf(const SimulatedInput& simulated) {
  return GyroRotation(simulated.input.imus[0].samples, simulated.input.start_ns,
                      simulated.truth.imus[0].gyroscope_bias_rad_s);
}

// Poses within the gyroscope's samples; others cannot be checked.
double worstError_rad(const std::vector<CameraPose>& poses, const SimulatedInput& simulated) {
  const SinusoidMotion motion(simulated.truth);
  double worst = 0.0;
  for (const CameraPose& pose : poses) {
    if (pose.time_s + 0.31 > simulated.truth.duration_s) continue;
    const auto truth = motion.worldFromCamera(0, pose.time_s + simulated.truth.cameras[0].time_offset_s);
    worst = std::max(worst, rotationAngleBetween_rad(pose.world_from_camera.rotation, truth.rotation));
  }
  return worst;
}

}  // namespace

class TestPoseConsistency : public QObject {
  Q_OBJECT

 private slots:
  void keep_leavesGoodPosesAlone() {
    Prepared p = prepare();
    const std::size_t before = p.poses.size();
    const PoseConsistency result = keepConsistentPoses(p.poses, gyroOf(p.simulated), p.hand_eye, {});
    QCOMPARE(result.swapped, 0);
    QCOMPARE(result.dropped, 0);
    QCOMPARE(p.poses.size(), before);
    QVERIFY(result.usual_rad < 0.01);
  }

  // A third of the views has the plane's other pose: the gyroscope corrects them.
  void keep_swapsMirroredPoses() {
    Prepared p = prepare();
    int wrong = 0;
    for (std::size_t k = 0; k < p.poses.size(); ++k) {
      CameraPose& pose = p.poses[k];
      pose.other_world_from_camera = mirrored(pose.world_from_camera);
      const bool tilted = rotationAngleBetween_rad(pose.other_world_from_camera->rotation,
                                                   pose.world_from_camera.rotation) > 0.15;
      if (k % 3 != 0 || !tilted) continue;
      std::swap(pose.world_from_camera, *pose.other_world_from_camera);
      ++wrong;
    }
    QVERIFY(wrong > 50);
    QVERIFY(worstError_rad(p.poses, p.simulated) > 0.15);
    const PoseConsistency result = keepConsistentPoses(p.poses, gyroOf(p.simulated), p.hand_eye, {});
    const double worst_rad = worstError_rad(p.poses, p.simulated);
    QVERIFY2(worst_rad < 0.1, qPrintable(QString("%1 swapped of %2, %3 dropped, worst %4 rad")
                                             .arg(result.swapped)
                                             .arg(wrong)
                                             .arg(result.dropped)
                                             .arg(worst_rad)));
  }

  void keep_dropsTurnedBoards() {
    Prepared p = prepare();
    int wrong = 0;
    for (std::size_t k = 0; k < p.poses.size(); k += 20, ++wrong) {
      p.poses[k].world_from_camera.rotation =
          quaternionExp({0.0, 0.0, M_PI}) * p.poses[k].world_from_camera.rotation;
    }
    const std::size_t before = p.poses.size();
    const PoseConsistency result = keepConsistentPoses(p.poses, gyroOf(p.simulated), p.hand_eye, {});
    QCOMPARE(result.dropped, wrong);
    QCOMPARE(p.poses.size(), before - static_cast<std::size_t>(wrong));
    QVERIFY(worstError_rad(p.poses, p.simulated) < 0.1);
  }
};

EVICAL_TEST(TestPoseConsistency)
#include "tst_pose_consistency.moc"
