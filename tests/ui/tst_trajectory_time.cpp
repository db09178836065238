// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view over time: its cursor, following the camera, views and states that arrive while a job runs.
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/shown_trajectory.h"
#include "ui/theme/theme.h"

#include <QDir>
#include <QElapsedTimer>
#include <QSignalSpy>

#include <algorithm>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;
using Eigen::Vector3d;

class TestTrajectoryTime : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    example_ = makeExample(5.0);
    QCOMPARE(example_.run->result.status, CalibrationStatus::Ok);
    has_opengl_ = hasOpenGl();
  }
  void init() { setPalette(false); }

  void rawPoses_lieOnTheTrajectory();
  void rawPoses_growWithTheDetections();
  void click_picksTheTime();
  void time_movesTheCamera();
  void followingTheCamera_keepsItInTheMiddle();
  void halfMinute_drawsFast();
  void liveStates_keepTheView();
  void screens_comeAndGoWhileBusy();

 private:
  Example example_;
  bool has_opengl_ = false;
};

void TestTrajectoryTime::rawPoses_lieOnTheTrajectory() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  for (int k = 0; k < kSceneLayerCount; ++k) screen->setLayerVisible(static_cast<SceneLayer>(k), false);
  screen->setLayerVisible(SceneLayer::RawPoses, true);
  const QImage image = picture(screen->view());
  const CalibrationState& state = example_.run->result.state;
  int found = 0, count = 0;
  for (const BoardView& view : example_.run->detections.cameras.front().views) {
    const auto rig = rigAt(state, view.time_s);
    if (!rig) continue;
    const auto at = screen->view()->project(rig->imu.world_from_imu.translation_m);
    QVERIFY(at);
    ++count;
    if (hasNear(image, *at, theme().good, 6)) ++found;
  }
  QVERIFY(count > 100);
  QVERIFY2(found > 0.8 * count, qPrintable(QString("%1 of %2").arg(found).arg(count)));
}

void TestTrajectoryTime::rawPoses_growWithTheDetections() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  TrajectoryScreen screen;
  screen.resize(1000, 650);
  screen.setBoards(example_.session);
  QImage before = picture(screen.view());
  for (const std::size_t views : {20U, 60U, 120U}) {
    auto some = std::make_shared<BoardObservations>(example_.run->detections.cameras.front());
    some->views.resize(views);
    const double last_s = some->views.back().time_s;
    screen.setDetections(sharedViews(some), *example_.session.cameras.front().intrinsics);
    QVERIFY(QTest::qWaitFor([&] { return !screen.busy(); }, kWorkPatience_ms));
    screen.setTime(last_s);
    const QImage after = picture(screen.view());
    QVERIFY(after != before);
    before = after;
  }
}

void TestTrajectoryTime::click_picksTheTime() {
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  QSignalSpy selected(screen.get(), &TrajectoryScreen::timeSelected);
  const auto rig = rigAt(example_.run->result.state, 3.3);
  QVERIFY(rig);
  const Vector3d position = rig->imu.world_from_imu.translation_m;
  const auto at = screen->view()->project(position);
  QVERIFY(at);
  QTest::mouseClick(screen->view(), Qt::LeftButton, {}, at->toPoint());
  QCOMPARE(selected.count(), 1);
  const double picked_s = selected.first().first().toDouble();
  QCOMPARE(screen->time_s(), picked_s);
  const auto picked = rigAt(example_.run->result.state, picked_s);
  QVERIFY(picked);
  const auto picked_at = screen->view()->project(picked->imu.world_from_imu.translation_m);
  QVERIFY(std::hypot(picked_at->x() - at->x(), picked_at->y() - at->y()) < 4.0);
  QTest::mouseClick(screen->view(), Qt::LeftButton, {}, {3, 3});
  QCOMPARE(selected.count(), 1);
}

void TestTrajectoryTime::time_movesTheCamera() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  QSignalSpy selected(screen.get(), &TrajectoryScreen::timeSelected);
  for (const double time_s : {1.0, 4.0}) {
    screen->setTime(time_s);
    const QImage image = picture(screen->view());
    const auto rig = rigAt(example_.run->result.state, time_s);
    const auto at = screen->view()->project(rig->world_from_cameras.front().translation_m);
    QVERIFY(hasNear(image, *at, theme().accent, 4));
  }
  QCOMPARE(selected.count(), 0);
}

void TestTrajectoryTime::followingTheCamera_keepsItInTheMiddle() {
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  QAction* const follow = screen->findChild<QAction*>("follow");
  QVERIFY(follow);
  follow->trigger();
  for (const double time_s : {0.5, 1.5, 4.5}) {
    screen->setTime(time_s);
    const auto rig = rigAt(example_.run->result.state, time_s);
    const auto at = screen->view()->project(rig->world_from_cameras.front().translation_m);
    QVERIFY(at);
    QVERIFY(std::abs(at->x() - 0.5 * screen->view()->width()) < 1e-6);
    QVERIFY(std::abs(at->y() - 0.5 * screen->view()->height()) < 1e-6);
  }
}

void TestTrajectoryTime::halfMinute_drawsFast() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  evical::test::RigOptions options;
  options.duration_s = 30.0;
  options.imu_rate_hz = 50.0;
  const evical::test::SimulatedRig rig = evical::test::simulateRig(options);
  std::unique_ptr<View3D> view;  // outlives the screen, whose destructor still uses it
  TrajectoryScreen screen;
  screen.view()->setParent(nullptr);
  view.reset(screen.view());
  view->resize(1000, 700);
  Session session;
  session.board = rig.input.board;
  screen.setBoards(session);
  screen.setState(truthOf(rig));
  screen.setDetections(
      sharedViews(std::make_shared<BoardObservations>(rig.input.cameras.front().observations)),
      *rig.input.cameras.front().lens.given);
  QVERIFY(QTest::qWaitFor([&] { return !screen.busy(); }, kWorkPatience_ms));
  screen.setTime(10.0);
  QImage target(1000, 700, QImage::Format_RGB32);
  constexpr int kMaxFrames = 400;
  const double max_ms = 20.0 * evical::ui::test::slowness();
  std::vector<double> times_ms;
  for (int k = 0; k < kMaxFrames && (k < 40 || *std::min_element(times_ms.begin(), times_ms.end()) >= max_ms);
       ++k) {
    QTest::keyClick(view.get(), Qt::Key_Left);
    QElapsedTimer timer;
    timer.start();
    view->render(&target);
    if (k >= 5) times_ms.push_back(1e-6 * static_cast<double>(timer.nsecsElapsed()));
  }
  std::sort(times_ms.begin(), times_ms.end());
  const double median_ms = times_ms[times_ms.size() / 2];
  qInfo("30 s at 1000x700: least %.1f, median %.1f, most %.1f ms", times_ms.front(), median_ms,
        times_ms.back());
  QVERIFY2(times_ms.front() < max_ms, qPrintable(QString::number(times_ms.front())));
}

void TestTrajectoryTime::liveStates_keepTheView() {
  TrajectoryScreen screen;
  screen.resize(1000, 650);
  screen.setBoards(example_.session);
  screen.setState(truthOf(example_.rig));
  QVERIFY(QTest::qWaitFor([&] { return !screen.busy(); }, kWorkPatience_ms));
  screen.grab();
  QTest::keyClick(screen.view(), Qt::Key_Left);
  const Vector3d eye = screen.view()->viewPose().eye_m;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto state =
        std::make_shared<const CalibrationState>(evical::test::disturbed(example_.rig.truth, seed, 0.0));
    screen.setState(state);
    QVERIFY(QTest::qWaitFor([&] { return !screen.busy(); }, kWorkPatience_ms));
    screen.grab();
    const Vector3d eye_now = screen.view()->viewPose().eye_m;
    QVERIFY2((eye_now - eye).norm() < 0.1, qPrintable(QString::number((eye_now - eye).norm())));
  }
}

void TestTrajectoryTime::screens_comeAndGoWhileBusy() {
  for (int k = 0; k < 20; ++k) {
    TrajectoryScreen screen;
    screen.resize(400, 300);
    screen.setRun(example_.run, example_.session);
    if (k % 2 == 0) screen.grab();
    QVERIFY(screen.busy());
  }
  QVERIFY(makeScreen(example_));
}

EVICAL_TEST(TestTrajectoryTime)
#include "tst_trajectory_time.moc"
