// Checks of an old calibration without a board: reports for an unchanged rig, for one with a change, and for
// recordings without enough information.
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/check/check_without_board.h"
#include "core/report/assessment_report.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/support/moving_camera.h"
#include "tests/support/scenario_session.h"
#include "tests/support/simulated_record.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <memory>

using namespace evical;
using namespace evical::test;

namespace {

Scenario room(double duration_s) {
  Scenario scenario = readScenario(test::scenarioPath("room"));
  scenario.duration_s = duration_s;
  return scenario;
}

// A small sensor, for few events.
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

BoardlessPass passOf(const Scenario& scenario, CameraRecord camera) {
  BoardlessPass pass;
  pass.start_ns = scenario.start_ns;
  pass.cameras.push_back(std::move(camera));
  pass.kinds.push_back(CameraKind::Events);
  for (std::size_t k = 0; k < scenario.imus.size(); ++k)
    pass.imus.push_back({scenario.imus[k].name, {}, simulateImu(scenario, k)});
  return pass;
}

// Motion like that of the scenario's camera, with this share of its velocity; `stretch`: factor of all image
// motion.
struct Seen {
  double velocity = 0.0, stretch = 1.0;
  double nearest_1_m = 0.3, further_1_m = 0.5;
};

CameraRecord turningCamera(const Scenario& scenario, const Seen& seen = {}) {
  const auto motion = std::make_shared<SinusoidMotion>(scenario);
  const double offset_s =
      truthOf(scenario).result->state.cameras.front().time_offset_s;  // with the pixels' delay
  MovingCamera camera;
  camera.slopes = 120;
  camera.noise = 0.05;
  camera.nearest_1_m = seen.nearest_1_m;
  camera.further_1_m = seen.further_1_m;
  const double start_s = 1e-9 * static_cast<double>(scenario.start_ns);
  camera.rate_rad_s = [=](double time_s) {
    return Eigen::Vector3d(seen.stretch *
                           motion->cameraAt(0, time_s - start_s + offset_s).angular_velocity_in_body_rad_s);
  };
  camera.velocity_m_s = [=](double time_s) {
    const MotionState state = motion->cameraAt(0, time_s - start_s + offset_s);
    return Eigen::Vector3d(seen.stretch * seen.velocity *
                           (state.world_from_body.rotation.conjugate() * state.velocity_in_world_m_s));
  };
  CameraRecord record = cameraRecord(camera, LensRays(scenario.cameras.front().intrinsics), start_s + 0.2,
                                     start_s + scenario.duration_s - 0.3, quickEgomotion(), 7);
  for (WindowMotion& window : record.windows) {
    window.begin_s -= start_s;
    window.end_s -= start_s;
  }
  return record;
}

// Evidence of a recording's events.
CameraRecord seenCamera(const Scenario& scenario) {
  CalibrationOptions options;
  options.egomotion = quickEgomotion();
  return simulatedRecord(scenario, options).record;
}

// `before`: the rig of the old result.
CalibrationCheck checkOf(const Scenario& before, BoardlessPass pass) {
  CheckInput input = checkInputOf(truthOf(before), sessionFor(before));
  input.session.options.egomotion = quickEgomotion();
  return checkWithoutBoard(input, std::move(pass)).check;
}

const Finding* changedOneForCheckWithoutBoard(const CalibrationCheck& check) {
  const auto found = std::find_if(check.findings.begin(), check.findings.end(),
                                  [](const Finding& each) { return each.changed; });
  return found == check.findings.end() ? nullptr : &*found;
}

bool says(const CalibrationCheck& check, const char* words) {
  return std::any_of(check.advice.begin(), check.advice.end(),
                     [&](const std::string& advice) { return advice.find(words) != std::string::npos; });
}

}  // namespace

class TestCheckWithoutBoard : public QObject {
  Q_OBJECT

  static void verifyCannotTell(const Scenario& scenario, const char* reason) {
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, seenCamera(scenario)));
    QVERIFY2(check.verdict == Verdict::CannotTell, check.reason.c_str());
    QVERIFY(!check.advice.empty() && check.without_board && check.windows.size() == 1);
    const auto& left_out = check.windows.front().left_out;
    const bool said = std::any_of(left_out.begin(), left_out.end(),
                                  [&](const CheckedWindows::LeftOut& one) { return one.key == reason; });
    QVERIFY2(said || check.windows.front().all == 0, windowsText(check.windows.front()).c_str());
  }

 private slots:
  void unchangedRig_isStillGood() {
    const Scenario scenario = room(30.0);
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, turningCamera(scenario)));
    QVERIFY2(check.verdict == Verdict::Unchanged, check.reason.c_str());
    QCOMPARE(check.findings.size(), std::size_t{2});  // rotation and time offset only
    QVERIFY(assessmentJson(check).find("\"without_board\": true") != std::string::npos);
    QVERIFY(assessmentYaml(check).find("without_board: true") != std::string::npos);
  }

  void changedQuantity_isNamedWithItsSize_data() {
    QTest::addColumn<double>("turn_deg");
    QTest::addColumn<double>("late_ms");
    QTest::newRow("turned") << 2.0 << 0.0;
    QTest::newRow("late") << 0.0 << 10.0;
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
    const CalibrationCheck check = checkOf(before, passOf(now, turningCamera(now)));
    QVERIFY2(check.verdict == Verdict::Changed, check.reason.c_str());
    const Finding* const changed = changedOneForCheckWithoutBoard(check);
    QVERIFY(changed != nullptr);
    QCOMPARE(changed->quantity, std::string(turn_deg > 0.0 ? "rotation" : "time_offset"));
    const double size = turn_deg + late_ms;
    QVERIFY2(std::abs(changed->change - size) < 0.2 * size, qPrintable(QString::number(changed->change)));
  }

  // At a hand's breadth from walls, translation dominates, and the verdict must still be true.
  void whatHangsOnTranslation_isNotKnownBetter() {
    const Scenario scenario = room(30.0);
    const CalibrationCheck check =
        checkOf(scenario, passOf(scenario, turningCamera(scenario, {3.0, 1.0, 1.0, 4.0})));
    QVERIFY2(check.verdict != Verdict::Changed, check.reason.c_str());
  }

  // Not the lens: translation moves near objects in the image.
  void walkingNearWalls_isAdvisedAgainst() {
    const Scenario scenario = room(30.0);
    for (const Seen& seen : {Seen{5.0, 1.0, 1.5, 1.0}, Seen{8.0, 1.0, 1.0, 1.0}}) {
      const CalibrationCheck check = checkOf(scenario, passOf(scenario, turningCamera(scenario, seen)));
      QVERIFY2(check.verdict == Verdict::CannotTell, check.reason.c_str());
      QVERIFY2(says(check, "walls"), check.advice.front().c_str());
    }
  }

  void withoutAnImu_cannotTell() {
    const Scenario scenario = room(30.0);
    BoardlessPass pass = passOf(scenario, turningCamera(scenario));
    pass.imus.clear();
    const CalibrationCheck check = checkOf(scenario, std::move(pass));
    QVERIFY(check.verdict == Verdict::CannotTell);
    QVERIFY2(check.reason.find("IMU") != std::string::npos, check.reason.c_str());
    QVERIFY(!check.advice.empty());
  }

  // A scale that differs from the gyroscope's: the lens is not this camera's.
  void anotherLens_isSaid() {
    const Scenario scenario = room(30.0);
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, turningCamera(scenario, {0.0, 1.3})));
    QVERIFY(check.verdict == Verdict::CannotTell);
    QVERIFY2(check.reason.find("times as fast") != std::string::npos, check.reason.c_str());
  }

  // The camera's motion does not agree with the gyroscope's at all.
  void anotherRigsGyroscope_cannotTell() {
    const Scenario scenario = room(30.0);
    BoardlessPass pass = passOf(scenario, turningCamera(scenario));
    Scenario other = scenario;
    other.seed += 1000;
    pass.imus = passOf(other, {}).imus;
    const CalibrationCheck check = checkOf(scenario, std::move(pass));
    QVERIFY2(check.verdict == Verdict::CannotTell, check.reason.c_str());
    QVERIFY2(says(check, "one rig"), check.reason.c_str());
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
    const CalibrationCheck check = checkOf(scenario, passOf(scenario, seenCamera(scenario)));
    QVERIFY2(check.verdict == Verdict::CannotTell, check.reason.c_str());
    QVERIFY(!check.advice.empty());
  }
};

EVICAL_TEST(TestCheckWithoutBoard)
#include "tst_check_without_board.moc"
