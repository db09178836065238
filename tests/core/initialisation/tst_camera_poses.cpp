#include "core/initialisation/camera_poses.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

struct PoseErrors {
  double rotation_rad = 0.0, translation_m = 0.0;  // RMS
};

PoseErrors errorsOfCameraPoses(const std::vector<CameraPose>& poses, const SimulatedInput& simulated) {
  const SinusoidMotion motion(simulated.truth);
  PoseErrors errors;
  for (const CameraPose& pose : poses) {
    const RigidTransform truth =
        motion.worldFromCamera(0, pose.time_s + simulated.truth.cameras[0].time_offset_s);
    const double angle = rotationAngleBetween_rad(pose.world_from_camera.rotation, truth.rotation);
    errors.rotation_rad += angle * angle;
    errors.translation_m += (pose.world_from_camera.translation_m - truth.translation_m).squaredNorm();
  }
  const auto count = static_cast<double>(poses.size());
  return {std::sqrt(errors.rotation_rad / count), std::sqrt(errors.translation_m / count)};
}

}  // namespace

class TestCameraPoses : public QObject {
  Q_OBJECT

 private slots:
  // Circles of different times, centres of ellipses instead of circles: both are taken into account.
  void estimate_withoutNoise_isExact() {
    SimulationOptions options;
    options.duration_s = 4.0;
    options.centre_sigma_px = 0.0;
    const SimulatedInput simulated = simulateInput(options);
    const CameraPoses found = estimateCameraPoses(simulated.input.cameras[0], simulated.input.board, {});
    QCOMPARE(found.poses.size(), simulated.input.cameras[0].observations.views.size());
    QCOMPARE(found.rejected, 0);
    QVERIFY(found.median_reprojection_px < 1e-3);
    const PoseErrors errors = errorsOfCameraPoses(found.poses, simulated);
    QVERIFY(errors.rotation_rad < 1e-5);
    QVERIFY(errors.translation_m < 1e-5);
  }

  void estimate_withNoise_staysNear() {
    SimulationOptions options;
    options.duration_s = 6.0;
    const SimulatedInput simulated = simulateInput(options);
    const CameraPoses found = estimateCameraPoses(simulated.input.cameras[0], simulated.input.board, {});
    const PoseErrors errors = errorsOfCameraPoses(found.poses, simulated);
    QVERIFY(errors.rotation_rad < 0.006);  // 0.15 px over an image of 150 px, three times worse for tilt
    QVERIFY(errors.translation_m < 0.004);
  }

  void estimate_rejectsViewsAboveBound() {
    SimulationOptions options;
    options.duration_s = 2.0;
    SimulatedInput simulated = simulateInput(options);
    auto& views = simulated.input.cameras[0].observations.views;
    for (std::size_t k = 0; k < views.size(); k += 4) views[k].circles[10].centre_px.x() += 40.0;
    const CameraPoses found = estimateCameraPoses(simulated.input.cameras[0], simulated.input.board, {});
    QCOMPARE(found.rejected, static_cast<int>((views.size() + 3) / 4));
    for (const CameraPose& pose : found.poses) QVERIFY(pose.view % 4 != 0);
  }

  void estimate_onFewCircles_givesNothing() {
    SimulationOptions options;
    options.duration_s = 1.0;
    SimulatedInput simulated = simulateInput(options);
    for (BoardView& view : simulated.input.cameras[0].observations.views) view.circles.resize(3);
    QVERIFY(estimateCameraPoses(simulated.input.cameras[0], simulated.input.board, {}).poses.empty());
  }
};

EVICAL_TEST(TestCameraPoses)
#include "tst_camera_poses.moc"
