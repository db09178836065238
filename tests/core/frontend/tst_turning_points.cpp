// At turning points of the motion, edges leave pixels without crossing them. This must not shift circles: a
// lag while the image accelerates and a lead while it decelerates look like a motion of another amplitude.
#include "core/frontend/board_tracker.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace {

using namespace evical;

// Motion of some ten pixels back and forth, several times a second.
Scenario smallMotion() {
  Scenario scenario;
  scenario.seed = 5;
  scenario.duration_s = 4.0;
  scenario.board = {BoardType::AsymmetricCircles, 11, 4, 0.03, 0.012, CircleShade::Dark, 0.0, {}};
  scenario.scene.clutter_contrast = 0.0;
  scenario.motion.distance_amplitude_m = 0.02;
  scenario.motion.angle_amplitude_rad = {0.1, 0.1, 0.1};
  scenario.motion.target_amplitude_m = {0.02, 0.02};
  scenario.motion.lowest_frequency_hz = 0.5;
  scenario.motion.highest_frequency_hz = 3.0;
  scenario.motion.image_speed_px_s = 0.0;
  SimulatedCamera camera;
  camera.intrinsics.resolution_px = {346, 260};
  camera.intrinsics.focal_length_px = {260.0, 260.0};
  camera.intrinsics.principal_point_px = {172.5, 129.5};
  scenario.cameras.push_back(camera);
  scenario.imus.emplace_back();
  return scenario;
}

class TestTurningPoints : public QObject {
  Q_OBJECT
 private slots:
  void slowCentres_areAsFarBehindBeforeATurnAsAfterIt();
};

void TestTurningPoints::slowCentres_areAsFarBehindBeforeATurnAsAfterIt() {
  const Scenario scenario = smallMotion();
  const SinusoidMotion motion(scenario);
  BoardTracker tracker(scenario.board, scenario.cameras[0].intrinsics.resolution_px,
                       scenario.cameras[0].intrinsics, FrontEndOptions{}, scenario.start_ns);
  simulateEvents(scenario, 0, [&](EventSpan events) { tracker.add(events); });
  const BoardObservations observations = tracker.finish();
  constexpr double kSlowest_px_s = 20.0, kFastest_px_s = 50.0, kStep_s = 1e-3;
  std::array<double, 2> behind_px = {0.0, 0.0};  // while the image decelerates, and while it accelerates
  std::array<int, 2> counts = {0, 0};
  for (const BoardView& view : observations.views) {
    for (const CircleObservation& circle : view.circles) {
      const auto at = [&](double time_s) {
        const std::vector<TrueCircle> truths = trueBoardView(motion, scenario, 0, time_s);
        return *std::find_if(truths.begin(), truths.end(),
                             [&](const TrueCircle& truth) { return truth.circle == circle.circle; });
      };
      const TrueCircle truth = at(circle.time_s);
      const double speed = truth.velocity_px_s.norm();
      if (speed < kSlowest_px_s || speed > kFastest_px_s) continue;
      const std::size_t speeding = at(circle.time_s + kStep_s).velocity_px_s.norm() > speed ? 1 : 0;
      behind_px[speeding] += (truth.centre_px - circle.centre_px).dot(truth.velocity_px_s) / speed;
      ++counts[speeding];
    }
  }
  QVERIFY2(counts[0] > 200 && counts[1] > 200, qPrintable(QString("%1, %2").arg(counts[0]).arg(counts[1])));
  const double slowing_px = behind_px[0] / counts[0], speeding_px = behind_px[1] / counts[1];
  // A difference of 0.08 px if every burst counted by its own median; the error of a mean is 0.002 px.
  QVERIFY2(std::abs(slowing_px - speeding_px) < 0.025,
           qPrintable(QString("%1 px, %2 px").arg(slowing_px).arg(speeding_px)));
}

}  // namespace

EVICAL_TEST(TestTurningPoints)
#include "tst_turning_points.moc"
