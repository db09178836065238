#include "core/base/error.h"
#include "core/initialisation/camera_trajectory.h"
#include "core/initialisation/initialise.h"
#include "tests/core/initialisation/simulated_input.h"

#include <QtTest>

#include <cmath>
#include <utility>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kDegPerRad = 57.29577951308232;

SimulatedInput twoCameras() {
  SimulationOptions options;
  options.duration_s = 8.0;
  options.cameras = 2;
  SimulatedInput simulated = simulateInput(options);
  simulated.input.imus.clear();
  return simulated;
}

// Of camera `k` against the reference; good enough that the batch converges.
void verifyRoughly(const Initialisation& found, const SimulatedInput& simulated, std::size_t reference,
                   std::size_t k, std::size_t state) {
  const SimulatedCamera &from = simulated.truth.cameras[k], &to = simulated.truth.cameras[reference];
  const RigidTransform truth = inverse(to.imu_from_camera) * from.imu_from_camera;
  const CameraState& camera = found.state.cameras[state];
  QVERIFY(kDegPerRad * rotationAngleBetween_rad(camera.imu_from_camera.rotation, truth.rotation) < 0.2);
  QVERIFY((camera.imu_from_camera.translation_m - truth.translation_m).norm() < 0.005);
  QVERIFY(std::abs(camera.time_offset_s - (from.time_offset_s - to.time_offset_s)) < 2e-3);
}

}  // namespace

class TestCamerasAlone : public QObject {
  Q_OBJECT

 private slots:
  void secondCamera_isFound() {
    const SimulatedInput simulated = twoCameras();
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    QCOMPARE(found.state.cameras.size(), std::size_t{2});
    QCOMPARE(found.state.cameras[0].time_offset_s, 0.0);
    QCOMPARE(found.state.cameras[0].imu_from_camera.translation_m.norm(), 0.0);
    verifyRoughly(found, simulated, 0, 1, 1);
  }

  void referenceBehindTheOther_isUsed() {
    SimulatedInput simulated = twoCameras();
    simulated.input.reference_camera = 1;
    verifyRoughly(initialise(simulated.input, {}, RunContext{}), simulated, 1, 0, 0);
  }

  // They take turns of 1 s: the trajectory between says nothing.
  void camerasThatNeverSeeTheBoardTogether_areRefused() {
    SimulatedInput simulated = twoCameras();
    for (std::size_t k = 0; k < 2; ++k) {
      const double offset_s = simulated.truth.cameras[k].time_offset_s;
      std::erase_if(simulated.input.cameras[k].observations.views, [&](const BoardView& view) {
        return static_cast<std::size_t>(view.time_s + offset_s + 1.0) % 2 != k;
      });
    }
    try {
      initialise(simulated.input, {}, RunContext{});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      const QString text = error.what();
      QVERIFY2(text.contains("at the same time"), error.what());
    }
  }

  void ambiguousPoses_followTheirNeighbours() {
    std::vector<CameraPose> poses(50);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const double angle = 0.01 * static_cast<double>(k);
      const RigidTransform right{Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX())),
                                 Eigen::Vector3d::Zero()};
      const RigidTransform mirrored{
          Eigen::Quaterniond(Eigen::AngleAxisd(-0.6 - angle, Eigen::Vector3d::UnitX())),
          Eigen::Vector3d::Zero()};
      poses[k].time_s = 0.02 * static_cast<double>(k);
      const bool wrong = k % 5 == 2;
      poses[k].world_from_camera = wrong ? mirrored : right;
      if (wrong || k % 3 == 0) poses[k].other_world_from_camera = wrong ? right : mirrored;
    }
    QVERIFY(resolveBySmoothness(poses, 0.1) >= 10);
    for (std::size_t k = 1; k < poses.size(); ++k)
      QVERIFY(rotationAngleBetween_rad(poses[k - 1].world_from_camera.rotation,
                                       poses[k].world_from_camera.rotation) < 0.02);
  }
};

QTEST_APPLESS_MAIN(TestCamerasAlone)
#include "tst_cameras_alone.moc"
