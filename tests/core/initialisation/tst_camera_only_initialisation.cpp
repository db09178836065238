#include "core/base/error.h"
#include "core/initialisation/camera_only_initialisation.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/initialise.h"
#include "core/numerics/angles.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <utility>

using namespace evical;
using namespace evical::test;

namespace {

SimulatedInput twoCameras() {
  SimulationOptions options;
  options.duration_s = 8.0;
  options.cameras = 2;
  SimulatedInput simulated = simulateInput(options);
  simulated.input.imus.clear();
  return simulated;
}

// They see the board alternately for `turn_s`, with `gap_s` between.
SimulatedInput camerasInTurns(double turn_s, double gap_s) {
  SimulatedInput simulated = twoCameras();
  for (std::size_t k = 0; k < 2; ++k) {
    const double offset_s = simulated.truth.cameras[k].time_offset_s;
    std::erase_if(simulated.input.cameras[k].observations.views, [&](const BoardView& view) {
      const double turns = (view.time_s + offset_s + 1.0) / turn_s;
      return static_cast<std::size_t>(turns) % 2 != k || (turns - std::floor(turns)) * turn_s < gap_s;
    });
  }
  return simulated;
}

struct Errors {
  double rotation_deg = 0.0, translation_m = 0.0, time_offset_s = 0.0;
};

// Error of camera `k` relative to the reference.
Errors errorsOfCamerasAlone(const CameraState& camera, const SimulatedInput& simulated, std::size_t reference,
                            std::size_t k) {
  const SimulatedCamera &from = simulated.truth.cameras[k], &to = simulated.truth.cameras[reference];
  const RigidTransform truth = inverse(to.imu_from_camera) * from.imu_from_camera;
  return {kDegPerRad * rotationAngleBetween_rad(camera.reference_from_camera.rotation, truth.rotation),
          (camera.reference_from_camera.translation_m - truth.translation_m).norm(),
          std::abs(camera.time_offset_s - (from.time_offset_s - to.time_offset_s))};
}

// Accurate enough that the batch converges.
void verifyRoughlyForCamerasAlone(const Initialisation& found, const SimulatedInput& simulated,
                                  std::size_t reference, std::size_t k, std::size_t state) {
  const Errors errors = errorsOfCamerasAlone(found.state.cameras[state], simulated, reference, k);
  QVERIFY(errors.rotation_deg < 0.2);
  QVERIFY(errors.translation_m < 0.005);
  QVERIFY(errors.time_offset_s < 2e-3);
}

// The batch ends nearer to the truth, with sigmas that match its errors.
void verifyBatch(const SimulatedInput& simulated, const Initialisation& found) {
  const BatchSolution solution = optimiseBatch(simulated.input, found.state, {}, {});
  const UncertaintyEstimate estimate = estimateUncertainty(simulated.input, solution, {}, {});
  const Errors errors = errorsOfCamerasAlone(solution.state.cameras[1], simulated, 0, 1);
  const CameraUncertainty& sigma = estimate.report.cameras[1];
  const double rotation_std_deg = kDegPerRad * sigma.rotation_std_rad.norm(),
               translation_std_m = sigma.translation_std_m.norm();
  qInfo("final errors %.3f deg (%.3f), %.2f mm (%.2f), %.2f ms (%.2f)", errors.rotation_deg, rotation_std_deg,
        errors.translation_m * 1e3, translation_std_m * 1e3, errors.time_offset_s * 1e3,
        sigma.time_offset_std_s * 1e3);
  constexpr double kSigmas = 3.0;
  QVERIFY(errors.rotation_deg < kSigmas * rotation_std_deg);
  QVERIFY(errors.translation_m < kSigmas * translation_std_m);
  QVERIFY(errors.time_offset_s < kSigmas * sigma.time_offset_std_s);
  QVERIFY(rotation_std_deg < 0.2);
  QVERIFY(translation_std_m < 0.003);
  QVERIFY(sigma.time_offset_std_s < 0.003);
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
    QCOMPARE(found.state.cameras[0].reference_from_camera.translation_m.norm(), 0.0);
    verifyRoughlyForCamerasAlone(found, simulated, 0, 1, 1);
  }

  void referenceBehindTheOther_isUsed() {
    SimulatedInput simulated = twoCameras();
    simulated.input.reference_camera = 1;
    verifyRoughlyForCamerasAlone(initialise(simulated.input, {}, RunContext{}), simulated, 1, 0, 0);
  }

  void camerasThatSeeTheBoardInTurns_areFoundByTheMomentsBetween() {
    const SimulatedInput simulated = camerasInTurns(1.0, 0.02);
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    const Errors errors = errorsOfCamerasAlone(found.state.cameras[1], simulated, 0, 1);
    qInfo("errors %.3f deg, %.1f mm, %.1f ms", errors.rotation_deg, errors.translation_m * 1e3,
          errors.time_offset_s * 1e3);
    QVERIFY(errors.rotation_deg < 2.0);
    QVERIFY(errors.translation_m < 0.03);
    QVERIFY(errors.time_offset_s < 0.03);
    QVERIFY(!found.warnings.empty());
    verifyBatch(simulated, found);
  }

  void camerasInTurns_keepATimeOffsetThatIsGiven() {
    SimulatedInput simulated = camerasInTurns(1.0, 0.02);
    const double offset_s =
        simulated.truth.cameras[1].time_offset_s - simulated.truth.cameras[0].time_offset_s;
    simulated.input.cameras[1].prior.time_offset = KnownNumber{offset_s};
    const Initialisation found = initialise(simulated.input, {}, RunContext{});
    QCOMPARE(found.state.cameras[1].time_offset_s, offset_s);
    const Errors errors = errorsOfCamerasAlone(found.state.cameras[1], simulated, 0, 1);
    qInfo("errors %.3f deg, %.1f mm", errors.rotation_deg, errors.translation_m * 1e3);
    QVERIFY(errors.rotation_deg < 1.0);
    QVERIFY(errors.translation_m < 0.02);
  }

  void camerasWithLongGapsBetween_areRefused() {
    const SimulatedInput simulated = camerasInTurns(2.0, 0.8);
    try {
      initialise(simulated.input, {}, RunContext{});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("at the same time"), error.what());
    }
  }

  // Each change from the views of one camera to those of the other is a gap, also the first and the last one.
  void everyGap_isABridge_data() {
    QTest::addColumn<QString>("turns");  // of reference and camera, a quarter of a second each
    QTest::newRow("camera last") << "rcrc";
    QTest::newRow("reference last") << "crcr";
    QTest::newRow("many") << "rcrcrcrcrc";
  }
  void everyGap_isABridge() {
    QFETCH(const QString, turns);
    std::vector<CameraPose> reference, camera;
    for (qsizetype turn = 0; turn < turns.size(); ++turn)
      for (int k = 0; k < 10; ++k) {
        CameraPose pose;
        pose.time_s = 0.28 * static_cast<double>(turn) + 0.02 * k;
        pose.world_from_camera.rotation = Eigen::AngleAxisd(0.5 * pose.time_s, Eigen::Vector3d::UnitZ());
        pose.world_from_camera.translation_m = {0.1 * pose.time_s, 0.0, 1.0};
        (turns[turn] == 'r' ? reference : camera).push_back(pose);
      }
    InitialisationOptions options;
    options.min_bridges = 2;
    const auto bridged = bridgeCameras(reference, camera, KnownNumber{0.0}, options, {});
    QVERIFY(bridged.has_value());
    QCOMPARE(bridged->bridges, static_cast<int>(turns.size()) - 1);
    QVERIFY(bridged->reference_from_camera.mean.translation_m.norm() < 0.005);
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

EVICAL_TEST(TestCamerasAlone)
#include "tst_camera_only_initialisation.moc"
