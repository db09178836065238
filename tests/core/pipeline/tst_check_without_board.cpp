// An old calibration where there is no board: what is said of a rig that is as it was, of one of which something has changed,
// and of recordings that cannot tell.
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/camera_motion.h"
#include "core/pipeline/check_without_board.h"
#include "core/report/check_report.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <functional>
#include <random>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kWindow_s = 0.04;

Scenario room(double duration_s) {
  Scenario scenario = readScenario(std::filesystem::path(EVICAL_SOURCE_DIR) / "config/scenarios/room.yaml");
  scenario.duration_s = duration_s;
  return scenario;
}

// A small sensor, so that events are few.
Scenario smallRoom(double duration_s) {
  Scenario scenario = room(duration_s);
  CameraIntrinsics& lens = scenario.cameras.front().intrinsics;
  lens.resolution_px = {64, 48};
  lens.focal_length_px = {50.0, 50.0};
  lens.principal_point_px = {31.5, 23.5};
  lens.distortion = {};
  return scenario;
}

void standStill(MotionModel& motion) {
  motion.angle_amplitude_rad.setConstant(1e-5);
  motion.walk_amplitude_m.setZero();
  motion.target_amplitude_m.setZero();
  motion.distance_amplitude_m = 0.0;
  motion.hand.walking_m = 0.0;
}

BoardlessPass passOf(const Scenario& scenario, std::vector<WindowMotion> windows) {
  BoardlessPass pass;
  pass.start_ns = scenario.start_ns;
  pass.cameras.push_back(std::move(windows));
  pass.kinds.push_back(CameraKind::Events);
  for (std::size_t k = 0; k < scenario.imus.size(); ++k)
    pass.imus.push_back({scenario.imus[k].name, {}, simulateImu(scenario, k)});
  return pass;
}

// As a perfect camera turns, with noise.
std::vector<WindowMotion> turningWindows(const Scenario& scenario, double sigma_rad_s) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  const SinusoidMotion motion(scenario);
  const SimulatedCamera& camera = scenario.cameras.front();
  std::vector<WindowMotion> windows;
  for (double begin_s = 0.2; begin_s + 0.3 < scenario.duration_s; begin_s += kWindow_s) {
    WindowMotion& window = windows.emplace_back();
    window.use = WindowUse::Used;
    window.begin_s = begin_s;
    window.end_s = begin_s + kWindow_s;
    window.part_weights.fill(1.0 / static_cast<double>(WindowMotion::kParts));
    const double time_s = window.middle_s() + camera.time_offset_s;
    window.rate_rad_s =
        motion.cameraAt(0, time_s).angular_velocity_in_body_rad_s +
        sigma_rad_s * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    window.turning_alone_rad_s = window.rate_rad_s;
    window.covariance = sigma_rad_s * sigma_rad_s * Eigen::Matrix3d::Identity();
  }
  return windows;
}

// The windows of a recording's events.
std::vector<WindowMotion> seenWindows(const Scenario& scenario) {
  const CalibrationOptions options;
  const SimulatedCamera& camera = scenario.cameras.front();
  CameraMotion motion(camera.intrinsics, options, scenario.start_ns);
  BurstExtractor bursts(camera.intrinsics.resolution_px, options.front_end.bursts);
  std::vector<EdgeBurst> found;
  simulateEvents(
      scenario, 0,
      [&](EventSpan events) {
        found.clear();
        bursts.add(events, found);
        motion.add(found, bursts.completeUntil_ns());
      },
      {}, 1);
  found.clear();
  bursts.finish(found);
  motion.add(found, bursts.completeUntil_ns());
  return motion.finish();
}

// `before`: the rig as the old result has it.
CalibrationCheck checkOf(const Scenario& before, BoardlessPass pass) {
  const CheckInput input = checkInputOf(truthOf(before), sessionFor(before));
  return checkWithoutBoard(input, std::move(pass)).check;
}

const CheckedQuantity* changedOne(const CalibrationCheck& check) {
  const auto found = std::find_if(check.quantities.begin(), check.quantities.end(),
                                  [](const CheckedQuantity& each) { return each.changed; });
  return found == check.quantities.end() ? nullptr : &*found;
}

}  // namespace

class TestCheckWithoutBoard : public QObject {
  Q_OBJECT

  static void verifyCannotTell(const Scenario& scenario, const char* reason) {
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, seenWindows(scenario)));
    QVERIFY2(check.verdict == CheckVerdict::CannotTell, check.reason.c_str());
    QVERIFY(!check.advice.empty() && check.without_board && check.windows.size() == 1);
    const auto& left_out = check.windows.front().left_out;
    const bool said = std::any_of(left_out.begin(), left_out.end(),
                                  [&](const CheckedWindows::LeftOut& one) { return one.key == reason; });
    QVERIFY2(said || check.windows.front().all == 0, windowsText(check.windows.front()).c_str());
  }

 private slots:
  void unchangedRig_isStillGood() {
    const Scenario scenario = room(30.0);
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, turningWindows(scenario, 0.05)));
    QVERIFY2(check.verdict == CheckVerdict::StillGood, check.reason.c_str());
    QCOMPARE(check.quantities.size(), std::size_t{2});  // rotation and time offset, nothing else
    QVERIFY(checkJson(check).find("\"without_board\": true") != std::string::npos);
    QVERIFY(checkYaml(check).find("without_board: true") != std::string::npos);
  }

  void changedQuantity_isNamedWithItsSize_data() {
    QTest::addColumn<double>("turn_deg");
    QTest::addColumn<double>("late_ms");
    QTest::newRow("turned") << 3.0 << 0.0;
    QTest::newRow("late") << 0.0 << 20.0;
  }
  void changedQuantity_isNamedWithItsSize() {
    QFETCH(double, turn_deg);
    QFETCH(double, late_ms);
    const Scenario before = room(30.0);
    Scenario now = before;
    SimulatedCamera& camera = now.cameras.front();
    camera.imu_from_camera.rotation =
        quaternionExp(Eigen::Vector3d(0.0, kRadPerDeg * turn_deg, 0.0)) * camera.imu_from_camera.rotation;
    camera.time_offset_s += 1e-3 * late_ms;
    const CalibrationCheck check = checkOf(before, passOf(now, turningWindows(now, 0.05)));
    QVERIFY2(check.verdict == CheckVerdict::Changed, check.reason.c_str());
    const CheckedQuantity* const changed = changedOne(check);
    QVERIFY(changed != nullptr);
    QCOMPARE(changed->name, std::string(turn_deg > 0.0 ? "rotation" : "time_offset"));
    const double size = turn_deg + late_ms;
    QVERIFY2(std::abs(changed->change - size) < 0.2 * size, qPrintable(QString::number(changed->change)));
  }

  // Beside what translation does to windows the sigmas are as large as it is.
  void whatHangsOnTranslation_isNotKnownBetter() {
    const Scenario scenario = room(30.0);
    std::vector<WindowMotion> windows = turningWindows(scenario, 0.02);
    const Eigen::Matrix3d turned = so3Exp(Eigen::Vector3d(0.0, kRadPerDeg * 20.0, 0.0));
    for (WindowMotion& window : windows) window.turning_alone_rad_s = turned * window.turning_alone_rad_s;
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, windows));
    QVERIFY2(check.verdict == CheckVerdict::CannotTell, check.reason.c_str());
    QVERIFY(!check.advice.empty());
  }

  void withoutAnImu_cannotTell() {
    const Scenario scenario = room(30.0);
    BoardlessPass pass = passOf(scenario, turningWindows(scenario, 0.05));
    pass.imus.clear();
    const CalibrationCheck check = checkOf(scenario, std::move(pass));
    QVERIFY(check.verdict == CheckVerdict::CannotTell);
    QVERIFY2(check.reason.find("IMU") != std::string::npos, check.reason.c_str());
    QVERIFY(!check.advice.empty());
  }

  // Of another scale than the gyroscope's: the lens is not this camera's.
  void anotherLens_isSaid() {
    const Scenario scenario = room(30.0);
    std::vector<WindowMotion> windows = turningWindows(scenario, 0.05);
    for (WindowMotion& window : windows) window.rate_rad_s *= 1.3;
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, windows));
    QVERIFY(check.verdict == CheckVerdict::CannotTell);
    QVERIFY2(check.reason.find("times as fast") != std::string::npos, check.reason.c_str());
  }

  // Nothing of the camera's motion is the gyroscope's.
  void anotherRigsGyroscope_cannotTell() {
    const Scenario scenario = room(30.0);
    BoardlessPass pass = passOf(scenario, turningWindows(scenario, 0.05));
    Scenario other = scenario;
    other.seed += 1000;
    pass.imus = passOf(other, {}).imus;
    const CalibrationCheck check = checkOf(scenario, std::move(pass));
    QVERIFY2(check.verdict == CheckVerdict::CannotTell, check.reason.c_str());
  }

  void bareWalls_cannotTell() {
    Scenario scenario = smallRoom(4.0);
    scenario.scene.clutter_contrast = 0.0;
    scenario.room.tone = 0.0;
    verifyCannotTell(scenario, "few_edges");
  }

  void stillCamera_cannotTell() {
    Scenario scenario = smallRoom(4.0);
    standStill(scenario.motion);
    verifyCannotTell(scenario, "few_edges");
  }

  void lampThatFlickers_cannotTell() {
    Scenario scenario = smallRoom(4.0);
    standStill(scenario.motion);
    scenario.scene.lamp_flicker = 0.5;
    scenario.scene.lamp_flicker_hz = 100.0;
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, seenWindows(scenario)));
    QVERIFY2(check.verdict == CheckVerdict::CannotTell, check.reason.c_str());
    QVERIFY(!check.advice.empty());
  }
};

EVICAL_TEST(TestCheckWithoutBoard)
#include "tst_check_without_board.moc"
