#include "core/frontend/board_tracker.h"

#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "tests/support/test_program.h"

#include <QElapsedTimer>

#include <algorithm>
#include <cmath>
#include <stop_token>

namespace {

using namespace evical;

// A DAVIS346 in front of the standard board, with clutter behind it.
Scenario davis346ForBoardTracker() {
  Scenario scenario;
  scenario.seed = 11;
  scenario.duration_s = 2.0;
  scenario.board = {BoardType::AsymmetricCircles, 11, 4, 0.03, 0.012, CircleShade::Dark, 0.0, {}};
  SimulatedCamera camera;
  camera.intrinsics.resolution_px = {346, 260};
  camera.intrinsics.focal_length_px = {260.0, 260.0};
  camera.intrinsics.principal_point_px = {172.5, 129.5};
  camera.intrinsics.distortion = {-0.3, 0.08, 0.0, 0.0, 0.0};
  scenario.cameras.push_back(camera);
  scenario.imus.emplace_back();
  return scenario;
}

struct Detected {
  Scenario scenario = davis346ForBoardTracker();
  BoardObservations observations;
};

// Simulated once for all tests.
const std::vector<Event>& events() {
  static const std::vector<Event> all = [] {
    std::vector<Event> collected;
    simulateEvents(davis346ForBoardTracker(), 0,
                   [&](EventSpan span) { collected.insert(collected.end(), span.begin(), span.end()); });
    return collected;
  }();
  return all;
}

Detected detect(CandidateSource method, std::size_t packet = 20000) {
  Detected detected;
  FrontEndOptions options;
  options.detection.method = method;
  BoardTracker tracker(detected.scenario.board, {346, 260}, detected.scenario.cameras[0].intrinsics, options,
                       detected.scenario.start_ns);
  for (std::size_t i = 0; i < events().size(); i += packet)
    tracker.add(EventSpan(events().data() + i, std::min(packet, events().size() - i)));
  detected.observations = tracker.finish();
  return detected;
}

class TestBoardTracker : public QObject {
  Q_OBJECT
 private slots:
  void simulatedRecording_isSolved_data();
  void simulatedRecording_isSolved();
  void views_areInTimeOrder();
  void packets_doNotMatter();
  void noEvents_giveNothing();
  void boardLaidWrongly_isLaidAnewWithAllItsViews_data();
  void boardLaidWrongly_isLaidAnewWithAllItsViews();
  void boardThatWindowsContradict_isNone();
  void emptyTime_costsNothing();
  void askedToStop_itLooksAtNoMoreWindows();
};

void TestBoardTracker::simulatedRecording_isSolved_data() {
  QTest::addColumn<int>("method");
  QTest::newRow("ring vote") << static_cast<int>(CandidateSource::RingVote);
  QTest::newRow("normal flow") << static_cast<int>(CandidateSource::NormalFlow);
}

void TestBoardTracker::simulatedRecording_isSolved() {
  QFETCH(int, method);
  const Detected detected = detect(static_cast<CandidateSource>(method));
  const SinusoidMotion motion(detected.scenario);
  const BoardObservations& observations = detected.observations;
  const auto solved =
      std::count_if(observations.windows.begin(), observations.windows.end(), [](const auto& w) {
        return w.outcome == WindowOutcome::Complete || w.outcome == WindowOutcome::Partial;
      });
  QVERIFY(observations.windows.size() > 30);
  QVERIFY2(static_cast<double>(solved) >= 0.95 * static_cast<double>(observations.windows.size()),
           qPrintable(QString("%1 of %2").arg(solved).arg(observations.windows.size())));
  double squares = 0.0;
  int count = 0;
  for (const BoardView& view : observations.views) {
    for (const CircleObservation& circle : view.circles) {
      for (const TrueCircle& truth : trueBoardView(motion, detected.scenario, 0, circle.time_s)) {
        if (truth.circle != circle.circle) continue;
        squares += (truth.centre_px - circle.centre_px).squaredNorm();
        ++count;
      }
    }
  }
  QVERIFY(count > 1000);
  const double rms_px = std::sqrt(squares / count);
  QVERIFY2(rms_px < 0.3, qPrintable(QString::number(rms_px)));
}

void TestBoardTracker::views_areInTimeOrder() {
  const Detected detected = detect(CandidateSource::NormalFlow);
  const auto earlier = [](const auto& a, const auto& b) { return a.time_s < b.time_s; };
  const BoardObservations& observations = detected.observations;
  QVERIFY(std::is_sorted(observations.views.begin(), observations.views.end(), earlier));
  QVERIFY(std::is_sorted(observations.windows.begin(), observations.windows.end(), earlier));
  QCOMPARE(observations.events, static_cast<std::uint64_t>(events().size()));
  for (const BoardView& view : observations.views) {
    QVERIFY(std::is_sorted(view.circles.begin(), view.circles.end(),
                           [](const auto& a, const auto& b) { return a.circle < b.circle; }));
    for (const CircleObservation& circle : view.circles) QVERIFY(std::abs(circle.time_s - view.time_s) < 0.1);
  }
}

void TestBoardTracker::packets_doNotMatter() {
  const BoardObservations large = detect(CandidateSource::NormalFlow, 100000).observations;
  const BoardObservations small = detect(CandidateSource::NormalFlow, 1000).observations;
  QCOMPARE(small.windows.size(), large.windows.size());
  QCOMPARE(small.views.size(), large.views.size());
  for (std::size_t k = 0; k < small.views.size(); ++k) {
    QCOMPARE(small.views[k].circles.size(), large.views[k].circles.size());
    QVERIFY((small.views[k].circles[0].centre_px - large.views[k].circles[0].centre_px).norm() < 1e-6);
  }
}

void TestBoardTracker::noEvents_giveNothing() {
  BoardTracker tracker(davis346ForBoardTracker().board, {346, 260}, std::nullopt, FrontEndOptions{}, 0);
  tracker.add({});
  const BoardObservations observations = tracker.finish();
  QVERIFY(observations.views.empty() && observations.windows.empty());
}

// Near, so that its long side fills the image: misidentified by a quarter turn, it would extend beyond the
// image above and below.
Scenario landscape(std::uint64_t seed) {
  Scenario scenario = davis346ForBoardTracker();
  scenario.seed = seed;
  scenario.duration_s = 1.5;
  scenario.motion.distance_m = 0.29;
  scenario.motion.distance_amplitude_m = 0.01;
  scenario.motion.angle_amplitude_rad = {0.08, 0.08, 0.08};
  scenario.motion.target_amplitude_m = {0.005, 0.005};
  scenario.motion.roll_rad = M_PI / 2.0;
  return scenario;
}

// Circles with another index than the truth's, and all circles.
struct Numbering {
  int wrong = 0, all = 0;
  std::size_t views = 0;
};
Numbering numberingOf(const std::vector<BoardView>& views, const Scenario& scenario) {
  const SinusoidMotion motion(scenario);
  Numbering numbering;
  numbering.views = views.size();
  for (const BoardView& view : views) {
    for (const CircleObservation& circle : view.circles) {
      for (const TrueCircle& truth : trueBoardView(motion, scenario, 0, circle.time_s)) {
        if (truth.circle != circle.circle) continue;
        ++numbering.all;
        numbering.wrong += (truth.centre_px - circle.centre_px).norm() > 5.0;
      }
    }
  }
  return numbering;
}

// Numbering in a recording of this duration, in which a third of the image is silent for the first 0.3 s.
constexpr double kUncovered_s = 0.3;
Numbering numbering(std::uint64_t seed, double duration_s, const FrontEndOptions& options = {}) {
  Scenario scenario = landscape(seed);
  scenario.duration_s = duration_s;
  BoardTracker tracker(scenario.board, {346, 260}, scenario.cameras[0].intrinsics, options,
                       scenario.start_ns);
  const std::int64_t uncovered_ns = scenario.start_ns + static_cast<std::int64_t>(kUncovered_s * 1e9);
  std::vector<Event> seen;
  simulateEvents(scenario, 0, [&](EventSpan span) {
    seen.clear();
    std::copy_if(span.begin(), span.end(), std::back_inserter(seen),
                 [&](const Event& event) { return event.time_ns > uncovered_ns || event.x_px < 235; });
    tracker.add(seen);
  });
  return numberingOf(tracker.finish().views, scenario);
}

QString toText(const Numbering& n) {
  return QString("%1 of %2 wrong in %3 views").arg(n.wrong).arg(n.all).arg(n.views);
}

void TestBoardTracker::boardLaidWrongly_isLaidAnewWithAllItsViews_data() {
  QTest::addColumn<int>("seed");
  QTest::addColumn<double>("duration_s");
  QTest::addColumn<int>("min_views");
  for (const int seed : {1, 2, 3}) {
    QTest::addRow("seed %d, long after", seed) << seed << 1.5 << 30;
    QTest::addRow("seed %d, a few windows after", seed) << seed << 0.55 << 8;
  }
}

void TestBoardTracker::boardLaidWrongly_isLaidAnewWithAllItsViews() {
  QFETCH(int, seed);
  QFETCH(double, duration_s);
  QFETCH(int, min_views);
  const Numbering n = numbering(static_cast<std::uint64_t>(seed), duration_s);
  QVERIFY2(n.views > static_cast<std::size_t>(min_views), qPrintable(toText(n)));
  QVERIFY2(n.wrong == 0, qPrintable(toText(n)));
}

// This also shows that the recordings above are misidentified at first.
void TestBoardTracker::boardThatWindowsContradict_isNone() {
  FrontEndOptions options;
  options.grid.contradicting_looks = 1000;  // so that it is not identified again
  const Numbering n = numbering(3, 0.55, options);
  QVERIFY2(n.views == 0, qPrintable(toText(n)));
}

// At one step per window, a day takes six million.
void TestBoardTracker::emptyTime_costsNothing() {
  constexpr std::int64_t kDay_ns = 86'400LL * 1'000'000'000;
  const Detected usual = detect(CandidateSource::NormalFlow);
  std::vector<Event> torn = events();
  const std::int64_t half_ns = (torn.front().time_ns + torn.back().time_ns) / 2;
  for (Event& event : torn)
    if (event.time_ns > half_ns) event.time_ns += kDay_ns;
  const Detected same;
  BoardTracker tracker(same.scenario.board, {346, 260}, same.scenario.cameras[0].intrinsics,
                       FrontEndOptions{}, same.scenario.start_ns);
  QElapsedTimer timer;
  timer.start();
  for (std::size_t i = 0; i < torn.size(); i += 20'000)
    tracker.add(EventSpan(torn.data() + i, std::min<std::size_t>(20'000, torn.size() - i)));
  const BoardObservations observations = tracker.finish();
  QVERIFY2(timer.elapsed() < 60'000, qPrintable(QString::number(timer.elapsed())));
  QVERIFY2(
      observations.views.size() + 30 > usual.observations.views.size(),
      qPrintable(QString("%1 of %2").arg(observations.views.size()).arg(usual.observations.views.size())));
  QVERIFY(observations.windows.size() < usual.observations.windows.size() + 100);
  QVERIFY(observations.views.front().time_s < 1.0 && observations.views.back().time_s > 86'400.0);
}

void TestBoardTracker::askedToStop_itLooksAtNoMoreWindows() {
  std::stop_source source;
  const Detected same;
  BoardTracker tracker(same.scenario.board, {346, 260}, same.scenario.cameras[0].intrinsics,
                       FrontEndOptions{}, same.scenario.start_ns);
  tracker.stopWith(source.get_token());
  // Bursts of slow edges are delayed for longer than these events last, so the events are repeated.
  std::vector<Event> later = events();
  for (Event& event : later) event.time_ns += 2'000'000'000;
  tracker.add(events());
  tracker.add(EventSpan(later.data(), later.size() / 2));
  const std::size_t windows = tracker.observations().windows.size();
  QVERIFY2(windows > 3, qPrintable(QString::number(windows)));
  source.request_stop();
  tracker.add(EventSpan(later.data() + later.size() / 2, later.size() - later.size() / 2));
  QCOMPARE(tracker.finish().windows.size(), windows);
}

}  // namespace

EVICAL_TEST(TestBoardTracker)
#include "tst_board_tracker.moc"
