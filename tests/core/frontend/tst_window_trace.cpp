// The trace of trackWindow must agree with the tracker's result for that window.
#include "core/frontend/window_trace.h"

#include "core/frontend/board_search.h"
#include "core/frontend/board_tracker.h"
#include "core/synthetic/event_simulator.h"
#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

#include <map>

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kHalfSlot_s = 0.02;

Scenario davis346ForWindowTrace() {
  Scenario scenario;
  scenario.seed = 11;
  scenario.duration_s = 2.0;
  scenario.board = MovingBoard().board;
  SimulatedCamera camera;
  camera.intrinsics.resolution_px = kDavis_px;
  camera.intrinsics.focal_length_px = {260.0, 260.0};
  camera.intrinsics.principal_point_px = {172.5, 129.5};
  camera.intrinsics.distortion = {-0.3, 0.08, 0.0, 0.0, 0.0};
  scenario.cameras.push_back(camera);
  scenario.imus.emplace_back();
  return scenario;
}

// Keeps the tracker's result, and every motion from which it may have continued.
class Recorder : public FrontEndObserver {
 public:
  void windowTracked(const BurstWindow& window, const WindowTrace& trace) override {
    bursts.push_back(window.bursts().size());
    traces.push_back(trace);
    if (trace.held()) motions[trace.motion->time_ns] = *trace.motion;
  }
  void windowSearched(const BoardSearch& search, std::int64_t) override {
    if (search.motion) motions[search.motion->time_ns] = *search.motion;
  }
  // Motions of the search first: a window is tracked from it at its own time.
  BoardMotion startOf(const WindowTrace& trace) const {
    if (trace.predicted_from_ns == trace.prediction.time_ns) return trace.prediction;
    return motions.at(trace.predicted_from_ns);
  }

  std::vector<WindowTrace> traces;
  std::vector<std::size_t> bursts;
  std::map<std::int64_t, BoardMotion> motions;
};

// A board in a separate window, and the history from which the window is extracted.
struct TrackedBoard {
  MovingBoard moving;
  BoardScene scene = moving.scene();
  BurstHistory history;
  FrontEndOptions options;
  BurstWindow window{scene};

  // Circles for which keep(circle) is false fire no bursts.
  template <class Keep>
  explicit TrackedBoard(Keep&& keep) {
    std::mt19937 random(3);
    std::vector<EdgeCrossing> bursts = burstsOf(moving, 0.04, 0.1, random);
    std::erase_if(bursts, [&](const EdgeCrossing& burst) {
      const Eigen::Vector2d pixel(burst.x_px, burst.y_px);
      int nearest = 0;
      double nearest_px = 1e9;
      for (int i = 0; i < moving.board.pointCount(); ++i) {
        const double distance_px = (moving.imageAt(i, 0.0).centre_px - pixel).norm();
        if (distance_px < nearest_px) nearest = i;
        nearest_px = std::min(nearest_px, distance_px);
      }
      return !keep(nearest);
    });
    history.add(bursts);
  }
  WindowTrace track(TraceDetail detail = TraceDetail::Result) {
    return trackWindow({history, scene, options, 0}, WindowSlot::around(0, kHalfSlot_s), moving.motionAt(0.0),
                       window, detail);
  }
};

bool allCircles(int) {
  return true;
}

class TestWindowTrace : public QObject {
  Q_OBJECT
 private slots:
  void slot_aroundAMiddleHasItsWidth();
  void trace_saysWhatTheTrackerDid();
  void end_isTheFirstRuleThatFails();
  void details_areKeptWhenAskedFor();
  void inliers_areThoseOfTheFit();
  void viewToTrackFrom_isTheLastBefore();
  void motionAtView_isThatOfTheTracker();
};

void TestWindowTrace::slot_aroundAMiddleHasItsWidth() {
  for (const std::int64_t length_ns : {10'000'000, 10'000'001}) {
    const WindowSlot slot{5'000'000'000, 5'000'000'000 + length_ns};
    const WindowSlot again = WindowSlot::around(slot.middle_ns(), slot.half_s());
    QCOMPARE(again.begin_ns, slot.begin_ns);
    QCOMPARE(again.end_ns, slot.end_ns);
  }
}

void TestWindowTrace::trace_saysWhatTheTrackerDid() {
  const Scenario scenario = davis346ForWindowTrace();
  const FrontEndOptions options;
  BoardTracker tracker(scenario.board, kDavis_px, scenario.cameras[0].intrinsics, options, scenario.start_ns);
  Recorder recorder;
  tracker.observeWith(&recorder);
  BurstExtractor extractor(kDavis_px, options.bursts);
  std::vector<EdgeCrossing> bursts;
  simulateEvents(scenario, 0, [&](EventSpan span) {
    tracker.add(span);
    extractor.add(span, bursts);
  });
  const BoardScene scene = tracker.scene();
  const BoardObservations observations = tracker.finish();
  extractor.finish(bursts);
  BurstHistory history;
  history.add(bursts);
  BurstWindow window(scene);
  QVERIFY(recorder.traces.size() > 30);
  std::map<double, const WindowTrace*> by_time;
  for (std::size_t k = 0; k < recorder.traces.size(); ++k) {
    const WindowTrace& did = recorder.traces[k];
    const WindowSlot slot = WindowSlot::around(did.prediction.time_ns, did.report.half_width_s);
    const WindowTrace says = trackWindow({history, scene, options, scenario.start_ns}, slot,
                                         recorder.startOf(did), window, TraceDetail::Everything);
    QCOMPARE(window.bursts().size(), recorder.bursts[k]);
    QCOMPARE(says.ended, did.ended);
    QCOMPARE(says.report.outcome, did.report.outcome);
    QCOMPARE(says.report.time_s, did.report.time_s);
    QCOMPARE(says.report.events, did.report.events);
    QCOMPARE(says.expected, did.expected);
    QCOMPARE(says.circles.size(), did.circles.size());
    for (std::size_t c = 0; c < says.circles.size(); ++c) {
      QCOMPARE(says.circles[c].circle, did.circles[c].circle);
      QVERIFY(says.circles[c].centre_px == did.circles[c].centre_px);
      QVERIFY(says.circles[c].covariance_px2 == did.circles[c].covariance_px2);
    }
    if (did.held()) by_time[did.report.time_s] = &did;
  }
  // The tracker passes on its input.
  QVERIFY(observations.views.size() > 25);
  for (const BoardView& view : observations.views) {
    const WindowTrace& did = *by_time.at(view.time_s);
    QCOMPARE(view.kind == ViewKind::Complete, did.report.outcome == WindowOutcome::Complete);
    QCOMPARE(view.circles.size(), did.circles.size());
    QVERIFY(view.circles.front().centre_px == did.circles.front().centre_px);
  }
}

void TestWindowTrace::end_isTheFirstRuleThatFails() {
  TrackedBoard whole(allCircles);
  QCOMPARE(whole.track().ended, TrackingEnd::Held);
  QCOMPARE(whole.track().report.outcome, WindowOutcome::Complete);
  whole.options.grid.min_circles = 45;  // of 44
  QCOMPARE(whole.track().ended, TrackingEnd::TooFewCircles);
  QCOMPARE(whole.track().report.outcome, WindowOutcome::RefinementFailed);

  TrackedBoard part([](int circle) { return circle < 20; });
  const WindowTrace of_part = part.track();
  QCOMPARE(of_part.report.circles, 20);
  QCOMPARE(of_part.expected, 44);
  QCOMPARE(of_part.ended, TrackingEnd::TooFewOfExpected);

  TrackedBoard more([](int circle) { return circle < 24; });
  QCOMPARE(more.track().ended, TrackingEnd::Held);
  QCOMPARE(more.track().report.outcome, WindowOutcome::Partial);
  more.options.grid.min_partial = 0.6;  // 26.4
  QCOMPARE(more.track().report.outcome, WindowOutcome::TooFewInGrid);

  TrackedBoard nothing([](int) { return false; });
  QCOMPARE(nothing.track().ended, TrackingEnd::NoFit);
  QVERIFY(!nothing.track().motion);
}

void TestWindowTrace::details_areKeptWhenAskedFor() {
  TrackedBoard board([](int circle) { return circle != 17; });
  const WindowTrace result = board.track();
  QVERIFY(result.measurement.verdicts.empty() && result.measurement.inliers.empty());
  const WindowTrace everything = board.track(TraceDetail::Everything);
  QCOMPARE(everything.circles.size(), result.circles.size());
  QCOMPARE(everything.measurement.verdicts.size(), std::size_t{44});
  for (std::size_t k = 0; k < 44; ++k) {
    QCOMPARE(everything.measurement.verdicts[k],
             k == 17 ? CircleVerdict::TooFewBursts : CircleVerdict::Measured);
  }
}

// Bursts that the fit rejects are not inliers: away from the edge, grazing it, or at another time.
void TestWindowTrace::inliers_areThoseOfTheFit() {
  TrackedBoard board(allCircles);
  const WindowTrace trace = board.track(TraceDetail::Everything);
  int fitted = 0;
  for (const CircleObservation& circle : trace.circles) fitted += circle.events;
  QCOMPARE(static_cast<int>(trace.measurement.inliers.size()), fitted);
  const auto in_slot = std::count_if(
      board.window.bursts().begin(), board.window.bursts().end(),
      [](const WindowBurst& burst) { return std::abs(static_cast<double>(burst.time_s)) <= kHalfSlot_s; });
  QVERIFY2(fitted < in_slot, qPrintable(QString("%1 of %2").arg(fitted).arg(in_slot)));
}

void TestWindowTrace::viewToTrackFrom_isTheLastBefore() {
  BoardObservations observations;
  for (const double time_s : {1.0, 1.1, 1.3}) observations.views.push_back({time_s, ViewKind::Partial, {}});
  TrackingOptions options;
  options.max_gap_s = 0.25;
  const auto from = [&](double time_s) {
    const BoardView* const view = viewToTrackFrom(observations, time_s, options);
    return view ? view->time_s : -1.0;
  };
  QCOMPARE(from(1.0), -1.0);  // not before itself
  QCOMPARE(from(1.05), 1.0);
  QCOMPARE(from(1.3), 1.1);
  QCOMPARE(from(1.5), 1.3);
  QCOMPARE(from(1.6), -1.0);  // too long ago
}

void TestWindowTrace::motionAtView_isThatOfTheTracker() {
  TrackedBoard board(allCircles);
  const WindowTrace trace = board.track();
  const BoardView view{trace.report.time_s, ViewKind::Complete, trace.circles};
  const auto motion = motionAtView({board.history, board.scene, board.options, 0}, view);
  QVERIFY(motion.has_value());
  QCOMPARE(motion->time_ns, trace.motion->time_ns);
  for (const int circle : {0, 21, 43}) {
    const Eigen::Vector2d there =
        imageOfCircle(trace.motion->ideal_from_board, board.scene, circle)->centre_px;
    const Eigen::Vector2d found = imageOfCircle(motion->ideal_from_board, board.scene, circle)->centre_px;
    QVERIFY2((found - there).norm() < 0.02, qPrintable(QString::number((found - there).norm())));
    const double error_px_s = (motion->velocityAt(there) - trace.motion->velocityAt(there)).norm();
    QVERIFY2(error_px_s < 0.5, qPrintable(QString::number(error_px_s)));
  }
  QVERIFY(!motionAtView({board.history, board.scene, board.options, 0}, BoardView{}));
}

}  // namespace

EVICAL_TEST(TestWindowTrace)
#include "tst_window_trace.moc"
