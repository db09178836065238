// SPDX-License-Identifier: GPL-3.0-or-later
// A run in the 3D view.
#include "tests/support/test_program.h"
#include "tests/ui/screenshots.h"
#include "tests/ui/shown_trajectory.h"
#include "ui/scene/trajectory_scene.h"
#include "ui/theme/theme.h"

#include <QElapsedTimer>
#include <QSignalSpy>

#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;
using Eigen::Vector3d;

class TestTrajectoryScreen : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    example_ = makeExample(5.0);
    QCOMPARE(example_.run->result.status, CalibrationStatus::Ok);
    has_opengl_ = hasOpenGl();
  }
  void init() { setPalette(false); }

  void empty_saysWhatToDo();
  void board_isWhereItsCirclesAre();
  void trajectory_isDrawnInTheColourOfItsSpeed();
  void residual_coversWhatTheCameraSaw();
  void layers_comeAndGo();
  void throughTheCamera_showsWhatItSees();
  void kindsOfCameras_haveColoursAndALegend();
  void gravity_differsFromTheTrajectory();
  void sensors_areNamedAtTheirPoses();
  void theme_changesThePicture();
  void picture_isTakenAtTwiceTheSize_andTheScreenStaysAsItWas();
  void screenshots();

 private:
  Example example_;
  bool has_opengl_ = false;
};

void TestTrajectoryScreen::empty_saysWhatToDo() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  TrajectoryScreen screen;
  screen.resize(1000, 650);
  const QImage image = picture(screen.view());
  int written = 0;
  for (int x = 300; x < 700; ++x) {
    for (int y = image.height() / 2 - 10; y < image.height() / 2 + 10; ++y) {
      written += distance(image.pixelColor(x, y), theme().text) < 40.0 ? 1 : 0;
    }
  }
  QVERIFY2(written > 100, qPrintable(QString::number(written)));
}

void TestTrajectoryScreen::board_isWhereItsCirclesAre() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  TrajectoryScreen screen;
  screen.resize(1000, 650);
  screen.setBoards(example_.session);
  screen.setLayerVisible(SceneLayer::Axes, false);
  screen.grab();
  screen.view()->look(StandardView::Front);
  const QImage image = picture(screen.view());
  const Board& board = example_.session.board;
  for (int circle = 0; circle < board.pointCount(); ++circle) {
    const Eigen::Vector2d centre = board.point_m(circle);
    const auto inside = screen.view()->project({centre.x(), centre.y(), 0.0});
    const auto beside = screen.view()->project({centre.x(), centre.y() + 1.2 * board.radius_m, 0.0});
    QVERIFY(inside && beside);
    QVERIFY2(image.pixelColor(inside->toPoint()).lightness() < 60, qPrintable(QString::number(circle)));
    QVERIFY2(image.pixelColor(beside->toPoint()).lightness() > 200, qPrintable(QString::number(circle)));
  }
}

void TestTrajectoryScreen::trajectory_isDrawnInTheColourOfItsSpeed() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  for (const SceneLayer layer : {SceneLayer::Cameras, SceneLayer::CurrentCamera, SceneLayer::ImuAxes,
                                 SceneLayer::RawPoses, SceneLayer::Board}) {
    screen->setLayerVisible(layer, false);
  }
  const QImage image = picture(screen->view());
  const TrajectoryTrack track = sampleTrajectory(example_.run->result.state, {});
  const ColourScale scale{{}, scaleEnd(track.speeds_m_s), false};
  int found = 0, count = 0;
  for (std::size_t k = 0; k < track.times_s.size(); k += 5, ++count) {
    const auto at = screen->view()->project(track.positions_m[k]);
    QVERIFY(at);
    if (hasNear(image, *at, scale.colourOf(track.speeds_m_s[k]))) ++found;
  }
  QVERIFY2(found > 0.9 * count, qPrintable(QString("%1 of %2").arg(found).arg(count)));
  screen->setLayerVisible(SceneLayer::Trajectory, false);
  QVERIFY(picture(screen->view()) != image);
}

void TestTrajectoryScreen::residual_coversWhatTheCameraSaw() {
  const CalibrationResult& result = example_.run->result;
  const TrajectoryTrack track = sampleTrajectory(result.state, result.circle_residuals);
  QVERIFY(track.hasResiduals());
  QVERIFY(std::isfinite(track.residuals_px[track.nearest(2.5)]));
  double sum_px = 0.0;
  int count = 0;
  for (const double residual_px : track.residuals_px) {
    if (!std::isfinite(residual_px)) continue;
    sum_px += residual_px;
    ++count;
  }
  const double rms_px = result.cameras.front().reprojection_rms_px;
  QVERIFY2(std::abs(sum_px / count - rms_px) < 0.2 * rms_px, qPrintable(QString::number(sum_px / count)));
  QVERIFY(!sampleTrajectory(result.state, {}).hasResiduals());
}

void TestTrajectoryScreen::layers_comeAndGo() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  const QImage all = picture(screen->view());
  for (int k = 0; k < kSceneLayerCount; ++k) {
    if (static_cast<SceneLayer>(k) == SceneLayer::Events) continue;  // none were given
    const auto layer = static_cast<SceneLayer>(k);
    screen->setLayerVisible(layer, false);
    QVERIFY2(picture(screen->view()) != all, qPrintable(QString::number(k)));
    screen->setLayerVisible(layer, true);
    QCOMPARE(picture(screen->view()), all);
  }
}

void TestTrajectoryScreen::throughTheCamera_showsWhatItSees() {
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  QAction* const through = screen->findChild<QAction*>("through_camera");
  QVERIFY(through);
  through->trigger();
  screen->setTime(2.5);
  const CameraIntrinsics& intrinsics = *example_.session.cameras.front().intrinsics;
  const BoardView* view = nullptr;
  for (const BoardView& candidate : example_.run->detections.cameras.front().views) {
    if (std::abs(candidate.time_s - 2.5) < 0.011) view = &candidate;
  }
  QVERIFY(view);
  screen->setTime(view->time_s);
  const double scale = screen->view()->height() / (1.2 * intrinsics.resolution_px.height_px);
  for (const CircleObservation& circle : view->circles) {
    const Eigen::Vector2d centre = example_.session.board.point_m(circle.circle);
    const auto at = screen->view()->project({centre.x(), centre.y(), 0.0});
    QVERIFY(at);
    const Eigen::Vector2d from_axis_px = circle.centre_px +
                                         circle.velocity_px_s * (view->time_s - circle.time_s) -
                                         intrinsics.principal_point_px;
    QVERIFY(std::abs(at->x() - 0.5 * screen->view()->width() - scale * from_axis_px.x()) < 5.0);
    QVERIFY(std::abs(at->y() - 0.5 * screen->view()->height() - scale * from_axis_px.y()) < 5.0);
  }
  QTest::keyClick(screen->view(), Qt::Key_Left);
  QVERIFY(!through->isChecked());
}

void TestTrajectoryScreen::kindsOfCameras_haveColoursAndALegend() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  auto run = std::make_shared<CalibrationRun>(*example_.run);
  run->result.state.cameras.push_back(run->result.state.cameras.front());
  run->result.state.cameras.back().reference_from_camera.translation_m.x() += 0.1;
  run->detections.cameras.push_back(run->detections.cameras.front());
  run->detections.lenses.push_back(run->detections.lenses.front());
  const auto pixelsOf = [](const QImage& image, const QRect& where, const QColor& colour) {
    int count = 0;
    for (int y = where.top(); y <= where.bottom(); ++y) {
      for (int x = where.left(); x <= where.right(); ++x)
        count += distance(image.pixelColor(x, y), colour) < 10.0 ? 1 : 0;
    }
    return count;
  };
  int scene[2], corner[2];
  for (const bool frames : {false, true}) {
    run->detections.cameras.back().kind = frames ? CameraKind::Frames : CameraKind::Events;
    Example rig = example_;
    rig.run = run;
    const auto screen = makeScreen(rig);
    QVERIFY(screen);
    for (const SceneLayer layer : {SceneLayer::Axes, SceneLayer::ImuAxes, SceneLayer::RawPoses})
      screen->setLayerVisible(layer, false);
    const QImage image = picture(screen->view());
    const QRect legend(0, 0, 40, 80);
    scene[frames] = pixelsOf(image, image.rect(), theme().good) - pixelsOf(image, legend, theme().good);
    corner[frames] = std::min(pixelsOf(image, legend, theme().good), pixelsOf(image, legend, theme().accent));
    QVERIFY(!frames || screen->grab().save(screenshotPath("trajectory_kinds.png")));
  }
  QVERIFY2(scene[0] < 5 && scene[1] > 50, qPrintable(QString("%1 and %2").arg(scene[0]).arg(scene[1])));
  QVERIFY2(corner[0] == 0 && corner[1] > 50, qPrintable(QString("%1 and %2").arg(corner[0]).arg(corner[1])));
}

void TestTrajectoryScreen::gravity_differsFromTheTrajectory() {
  for (const bool dark : {false, true}) {
    setPalette(dark);
    const vtkNew<vtkRenderer> renderer;
    TrajectoryScene scene(renderer);
    scene.setBoard(example_.session.board);
    scene.setGravity(Vector3d(0.0, 9.81, 0.0));
    const SceneLabel label = scene.labels().back();
    QCOMPARE(label.text, QString("gravity"));
    QVERIFY(distance(label.colour, theme().panel) > 200.0);
    for (double share = 0.0; share <= 1.0; share += 0.1)
      QVERIFY(distance(label.colour, ColourScale{{}, 1.0, dark}.colourOf(share)) > 60.0);
  }
}

void TestTrajectoryScreen::sensors_areNamedAtTheirPoses() {
  const vtkNew<vtkRenderer> renderer;
  TrajectoryScene scene(renderer);
  scene.setBoard(example_.session.board);
  scene.setIntrinsics({std::nullopt, std::nullopt});
  scene.setSensorNames({"left", "right"}, {"imu"});
  const auto at = [](double x_m) { return RigidTransform{Eigen::Quaterniond::Identity(), {x_m, 0.0, -1.0}}; };
  scene.setInstant({at(0.0), at(2.0)}, {at(1.0)});
  const auto placeOf = [&](const QString& name) {
    for (const SceneLabel& label : scene.labels())
      if (label.text == name) return label.at_m.x();
    return std::numeric_limits<double>::quiet_NaN();
  };
  QVERIFY(std::abs(placeOf("left")) < 0.2 && std::abs(placeOf("right") - 2.0) < 0.2);
  QVERIFY(std::abs(placeOf("imu") - 1.0) < 0.2);
  scene.setVisible(SceneLayer::ImuAxes, false);
  QVERIFY(std::isnan(placeOf("imu")) && !std::isnan(placeOf("right")));
}

void TestTrajectoryScreen::theme_changesThePicture() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  screen->show();
  QVERIFY(distance(picture(screen->view()).pixelColor(2, 2), theme().panel) < 2.0);
  setPalette(true);
  QCoreApplication::processEvents();
  QVERIFY(theme().dark);
  QVERIFY(distance(picture(screen->view()).pixelColor(2, 2), theme().panel) < 2.0);
}

void TestTrajectoryScreen::picture_isTakenAtTwiceTheSize_andTheScreenStaysAsItWas() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  const auto screen = makeScreen(example_);
  QVERIFY(screen);
  const QImage before = picture(screen->view());
  const QImage once = screen->view()->picture(1.0), twice = screen->view()->picture(2.0);
  QCOMPARE(once.size(), screen->view()->size());
  QCOMPARE(twice.size(), 2 * once.size());
  QCOMPARE(picture(screen->view()), before);
  const QImage shrunk = twice.scaled(once.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
  int different = 0;
  for (int y = 0; y < once.height(); ++y)
    for (int x = 0; x < once.width(); ++x)
      different += distance(shrunk.pixelColor(x, y), once.pixelColor(x, y)) > 120.0 ? 1 : 0;
  QVERIFY2(different < once.width() * once.height() / 20, qPrintable(QString::number(different)));
}

void TestTrajectoryScreen::screenshots() {
  if (!has_opengl_) QSKIP("OpenGL is not available");
  for (const bool dark : {false, true}) {
    setPalette(dark);
    applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
    for (const QSize size : {QSize(1000, 650), QSize(1640, 930)}) {
      const auto screen = makeScreen(example_, size);
      QVERIFY(screen);
      const QString name =
          screenshotPath("trajectory_%1_%2.png").arg(size.width()).arg(dark ? "dark" : "light");
      QVERIFY(screen->grab().save(name));
    }
  }
}

EVICAL_TEST(TestTrajectoryScreen)
#include "tst_trajectory_screen.moc"
