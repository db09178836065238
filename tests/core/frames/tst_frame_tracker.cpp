// The board tracked through images of a moving camera.
#include "core/frames/frame_tracker.h"
#include "core/frames/views_from_frames.h"
#include "tests/support/rendered_board.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <ctime>

namespace {

using namespace evical;

PrintedBoard printedOf(BoardType type) {
  PrintedBoard printed;
  printed.board.type = type;
  printed.board.radius_m = 0.0;
  printed.board.tag_size_m = 0.0;
  if (type == BoardType::AsymmetricCircles) printed.board.radius_m = 0.02;
  if (type == BoardType::Checkerboard) {
    printed.board.rows = 6;
    printed.board.cols = 9;
  }
  if (type == BoardType::AprilGrid) {
    printed.board.rows = printed.board.cols = 6;
    printed.board.spacing_m = 0.07;
    printed.board.tag_size_m = 0.054;
  }
  return printed;
}

constexpr double kPeriod_s = 0.1;

// The board swings: some 100 px/s.
RigidTransform poseAt(const Board& board, double time_s) {
  return lookAt(board, 0.75,
                {0.3 * std::sin(2.0 * time_s), 0.3 * std::cos(1.5 * time_s), 0.2 * std::sin(time_s)},
                {0.05 * std::sin(3.0 * time_s), 0.03 * std::cos(2.5 * time_s)});
}

GrayImage grey() {
  return {{752, 480}, std::vector<std::uint8_t>(752 * 480, 128)};
}

class TestFrameTracker : public QObject {
  Q_OBJECT
 private slots:
  void movingBoard_isFollowed_data();
  void movingBoard_isFollowed();
  void lostBoard_isSearchedAgain();
  void fastBoard_isBlurred();
  void unreadableFrame_isReported();
  void frames_areThinnedToTheRate_data();
  void frames_areThinnedToTheRate();
  void velocity_isThatOfTheParabola();
  void blur_isAddedAlongTheMotion();
};

void TestFrameTracker::movingBoard_isFollowed_data() {
  QTest::addColumn<BoardType>("type");
  QTest::newRow("asymmetric circles") << BoardType::AsymmetricCircles;
  QTest::newRow("checkerboard") << BoardType::Checkerboard;
  QTest::newRow("Kalibr's grid") << BoardType::AprilGrid;
}

void TestFrameTracker::movingBoard_isFollowed() {
  QFETCH(const BoardType, type);
  const PrintedBoard printed = printedOf(type);
  const Board& board = printed.board;
  FrameTracker tracker("left", board, FrameOptions{});
  constexpr int kFrames = 12;
  double seconds = 0.0;
  for (int k = 0; k < kFrames; ++k) {
    const GrayImage image = renderBoard(printed, distortingCamera(), poseAt(board, k * kPeriod_s),
                                        {40, 200, 0.8, 4.0, static_cast<unsigned>(k)});
    const std::clock_t begin = std::clock();
    tracker.track(image, {k * kPeriod_s, 0.005});
    if (k > 1) seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  }
  const BoardObservations seen = tracker.finish();
  qInfo("%.2f ms per tracked frame", 1e3 * seconds / (kFrames - 2));
  QCOMPARE(seen.camera, std::string("left"));
  QCOMPARE(seen.views.size(), std::size_t{kFrames});
  QCOMPARE(seen.windows.size(), std::size_t{kFrames});
  for (std::size_t k = 0; k < seen.views.size(); ++k) {
    // One view does not determine motion, and the board moves further than the gate.
    if (k != 1) QCOMPARE(seen.windows[k].tracked, k > 1);
    QVERIFY(static_cast<int>(seen.views[k].circles.size()) > 0.9 * board.pointCount());
    QCOMPARE(seen.views[k].kind == ViewKind::Complete, seen.windows[k].outcome == WindowOutcome::Complete);
    for (const CircleObservation& point : seen.views[k].circles) {
      const auto truth = truePoint(board, point.circle, distortingCamera(), poseAt(board, point.time_s));
      QVERIFY(truth && (point.centre_px - *truth).norm() < 0.5);
      if (k == 0 || k + 1 == seen.views.size()) continue;
      const auto before =
          truePoint(board, point.circle, distortingCamera(), poseAt(board, point.time_s - 0.001));
      const auto after =
          truePoint(board, point.circle, distortingCamera(), poseAt(board, point.time_s + 0.001));
      QVERIFY((point.velocity_px_s - (*after - *before) / 0.002).norm() < 25.0);
    }
  }
}

void TestFrameTracker::lostBoard_isSearchedAgain() {
  const PrintedBoard printed = printedOf(BoardType::AsymmetricCircles);
  FrameTracker tracker("left", printed.board, FrameOptions{});
  const auto picture = [&](double time_s) {
    return renderBoard(printed, distortingCamera(), poseAt(printed.board, time_s), {});
  };
  tracker.track(picture(0.0), {0.0, 0.0});
  tracker.track(grey(), {0.1, 0.0});
  tracker.track(picture(2.0), {0.2, 0.0});  // somewhere else
  tracker.track(picture(2.0), {9.0, 0.0});  // too late to be predicted
  const BoardObservations seen = tracker.finish();
  QCOMPARE(seen.views.size(), std::size_t{3});
  QCOMPARE(seen.windows[1].outcome, WindowOutcome::NoLattice);
  for (const std::size_t k : {0, 2, 3}) {
    QCOMPARE(seen.windows[k].outcome, WindowOutcome::Complete);
    QVERIFY(!seen.windows[k].tracked);
  }
}

void TestFrameTracker::fastBoard_isBlurred() {
  const PrintedBoard printed = printedOf(BoardType::AsymmetricCircles);
  FrameTracker tracker("left", printed.board, FrameOptions{});
  for (int k = 0; k < 3; ++k)  // 20 px a frame and 30 ms of exposure: 6 px
    tracker.track(renderBoard(printed, distortingCamera(),
                              lookAt(printed.board, 0.75, Eigen::Vector3d::Zero(), {0.0326 * k, 0.0}), {}),
                  {0.1 * k, 0.03});
  const BoardObservations seen = tracker.finish();
  QVERIFY(seen.views.empty());
  for (const WindowReport& window : seen.windows) {
    QCOMPARE(window.outcome, WindowOutcome::Blurred);
    QCOMPARE(window.circles, 0);
    QVERIFY(window.candidates > 40);
  }
}

void TestFrameTracker::unreadableFrame_isReported() {
  FrameTracker tracker("left", printedOf(BoardType::Checkerboard).board, FrameOptions{});
  tracker.skipUnreadable({0.3, 0.01});
  const BoardObservations seen = tracker.finish();
  QVERIFY(seen.views.empty());
  QCOMPARE(seen.windows.front().outcome, WindowOutcome::Unreadable);
  QCOMPARE(seen.windows.front().time_s, 0.3);
}

void TestFrameTracker::frames_areThinnedToTheRate_data() {
  QTest::addColumn<double>("rate_hz");
  QTest::addColumn<double>("jitter_s");
  QTest::addColumn<int>("taken");
  QTest::newRow("every second") << 20.0 << 0.0 << 100;
  QTest::newRow("every third of 30") << 30.0 << 0.001 << 100;
  QTest::newRow("all at the rate") << 10.0 << 0.004 << 100;
  QTest::newRow("all of fewer") << 4.0 << 0.01 << 40;
}

void TestFrameTracker::frames_areThinnedToTheRate() {
  QFETCH(const double, rate_hz);
  QFETCH(const double, jitter_s);
  QFETCH(const int, taken);
  FrameRate rate(FrameOptions{});
  int count = 0;
  for (int k = 0; k < 10.0 * rate_hz; ++k) count += rate.isDue(k / rate_hz + (k % 3 - 1) * jitter_s);
  QVERIFY2(std::abs(count - taken) <= 1, std::to_string(count).c_str());
}

FoundPoint pointAt(int index, const Eigen::Vector2d& at) {
  FoundPoint point;
  point.point = index;
  point.at_px = at;
  point.covariance_px2 = 0.01 * Eigen::Matrix2d::Identity();
  return point;
}

void TestFrameTracker::velocity_isThatOfTheParabola() {
  const auto x = [](double t) { return 100.0 + 50.0 * t + 300.0 * t * t; };
  std::vector<PointsInFrame> frames;
  for (const double t : {0.0, 0.1, 0.25, 2.0}) frames.push_back({t, 0.0, {pointAt(3, {x(t), 7.0})}});
  const std::vector<ViewFromFrame> views = viewsFromFrames(frames, 10);
  QVERIFY(std::abs(views[1].view.circles[0].velocity_px_s.x() - (50.0 + 600.0 * 0.1)) < 1e-9);
  QVERIFY(std::abs(views[0].view.circles[0].velocity_px_s.x() - (x(0.1) - x(0.0)) / 0.1) < 1e-9);
  QVERIFY(std::abs(views[2].view.circles[0].velocity_px_s.x() - (x(0.25) - x(0.1)) / 0.15) < 1e-9);
  QCOMPARE(views[3].view.circles[0].velocity_px_s.x(), 0.0);  // no neighbour within a second
  QCOMPARE(views[3].view.kind, ViewKind::Partial);
}

void TestFrameTracker::blur_isAddedAlongTheMotion() {
  std::vector<PointsInFrame> frames;
  for (const double t : {0.0, 0.1}) frames.push_back({t, 0.02, {pointAt(0, {100.0 * t, 0.0})}});
  const CircleObservation point = viewsFromFrames(frames, 1).front().view.circles.front();
  QVERIFY(std::abs(point.covariance_px2(0, 0) - (0.01 + std::pow(0.1 * 100.0 * 0.02, 2))) < 1e-12);
  QVERIFY(std::abs(point.covariance_px2(1, 1) - 0.01) < 1e-12);
}

}  // namespace

EVICAL_TEST(TestFrameTracker)
#include "tst_frame_tracker.moc"
