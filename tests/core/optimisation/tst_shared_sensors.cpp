// Events and frames of one chip: one pose and one lens, and the events' latency.
#include "core/optimisation/uncertainty/shared_sensors.h"
#include "tests/core/optimisation/solved_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

test::SimulatedRig rigOfSharedSensors(unsigned seed,
                                      const Eigen::Vector3d& apart_m = Eigen::Vector3d::Zero()) {
  test::RigOptions options = test::shortRecording(seed);
  options.frames_too = true;
  options.frames_apart_m = apart_m;
  return test::simulateRig(options);
}

bool reports(const UncertaintyReport& report, std::size_t camera, QuantityId id) {
  return columnOf({QuantityOwner::Camera, camera, id}, report.columns).has_value();
}

}  // namespace

class TestSharedSensors : public QObject {
  Q_OBJECT

 private slots:
  void latency_hasAnHonestSigma() {
    constexpr unsigned kSeeds = 12;
    double squares = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig = rigOfSharedSensors(seed);
      const test::SolvedRig solved = solve(rig, seed, test::withoutPixelDelay());
      const std::vector<SensorLatency> latencies =
          sensorLatencies(rig.input, solved.solution.state, solved.estimate.report);
      QCOMPARE(latencies.size(), std::size_t{1});
      QCOMPARE(latencies[0].camera, std::size_t{0});  // that of the events
      const double truth_s = rig.truth.cameras[1].time_offset_s - rig.truth.cameras[0].time_offset_s;
      const double error_s = latencies[0].latency_s - truth_s;
      QVERIFY2(latencies[0].std_s > 1e-6 && latencies[0].std_s < 1e-4,
               QByteArray::number(latencies[0].std_s));
      squares += error_s * error_s / (latencies[0].std_s * latencies[0].std_s * kSeeds);
    }
    QVERIFY2(std::sqrt(squares) > 0.5 && std::sqrt(squares) < 1.5, QByteArray::number(std::sqrt(squares)));
  }

  void poseAndLens_areOne_andNoLessCertainThanOfEventsAlone() {
    const test::SimulatedRig rig = rigOfSharedSensors(1);
    const test::SolvedRig both = solve(rig, 1);
    const auto& cameras = both.solution.state.cameras;
    QCOMPARE(cameras[0].reference_from_camera.translation_m, cameras[1].reference_from_camera.translation_m);
    QCOMPARE(cameras[0].reference_from_camera.rotation.coeffs(),
             cameras[1].reference_from_camera.rotation.coeffs());
    QVERIFY(cameras[0].lens.solved && cameras[0].lens.solved == cameras[1].lens.solved);
    const UncertaintyReport& report = both.estimate.report;
    QVERIFY(reports(report, 0, QuantityId::Translation) && !reports(report, 1, QuantityId::Translation));
    QVERIFY(reports(report, 1, QuantityId::TimeOffset));
    QCOMPARE(report.cameras[1].translation_std_m, report.cameras[0].translation_std_m);

    test::SimulatedRig alone = rig;
    alone.input.cameras.pop_back();
    alone.truth.cameras.pop_back();
    const CameraUncertainty of_events = solve(alone, 1).estimate.report.cameras[0];
    constexpr double kScatter = 1.05;  // of sigmas that are estimated from the recording
    QVERIFY(report.cameras[0].translation_std_m.norm() < kScatter * of_events.translation_std_m.norm());
    QVERIFY(report.cameras[0].rotation_std_rad.norm() < kScatter * of_events.rotation_std_rad.norm());
  }

  void errors_areWithinTheirSigmas() {
    constexpr unsigned kSeeds = 12;
    constexpr Eigen::Index kExtrinsics = 6;
    double squares = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      test::SimulatedRig rig = rigOfSharedSensors(seed);
      const test::SolvedRig solved = solve(rig, seed);
      CalibrationState state = solved.solution.state;
      state.cameras.pop_back();  // whose quantities are in between
      rig.truth.cameras.pop_back();
      squares += test::reportedErrors(state, rig.truth)
                     .head(kExtrinsics)
                     .cwiseQuotient(solved.estimate.report.standard_deviations.head(kExtrinsics))
                     .squaredNorm() /
                 (kExtrinsics * kSeeds);
    }
    QVERIFY2(std::sqrt(squares) > 0.7 && std::sqrt(squares) < 1.4, QByteArray::number(std::sqrt(squares)));
  }

  void anotherSensor_isToldOf() {
    const std::string doubt = solve(rigOfSharedSensors(1, {0.0, 0.02, 0.0}), 1).estimate.other_sensors;
    QVERIFY2(doubt.find("frames is not the same sensor as left") == 0, doubt.c_str());
  }

  void theSameSensor_isNot() {
    OptimisationOptions apart;
    apart.share_sensors = false;
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const std::string doubt = solve(rigOfSharedSensors(seed), seed).estimate.other_sensors;
      QVERIFY2(doubt.empty(), doubt.c_str());
      const std::string compared = solve(rigOfSharedSensors(seed), seed, apart).estimate.other_sensors;
      QVERIFY2(compared.empty(), compared.c_str());
    }
  }

  void sensorsThatAreOnlyCompared_haveTheirOwn() {
    OptimisationOptions options;
    options.share_sensors = false;
    const test::SolvedRig same = solve(rigOfSharedSensors(1), 1, options);
    QVERIFY(reports(same.estimate.report, 1, QuantityId::Translation));
    const auto& cameras = same.solution.state.cameras;
    QVERIFY(cameras[0].reference_from_camera.translation_m != cameras[1].reference_from_camera.translation_m);
    const test::SolvedRig other = solve(rigOfSharedSensors(1, {0.0, 0.02, 0.0}), 1, options);
    const auto& apart = other.solution.state.cameras;
    const Eigen::Vector3d between_m =
        apart[1].reference_from_camera.translation_m - apart[0].reference_from_camera.translation_m;
    QVERIFY2((between_m - Eigen::Vector3d(0.0, 0.02, 0.0)).norm() < 3e-3,
             QByteArray::number(between_m.norm()));
    const std::string& doubt = other.estimate.other_sensors;
    QVERIFY2(doubt.find("frames is not the same sensor as left") == 0, doubt.c_str());
  }
};

EVICAL_TEST(TestSharedSensors)
#include "tst_shared_sensors.moc"
