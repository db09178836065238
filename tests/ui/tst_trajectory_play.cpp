// SPDX-License-Identifier: GPL-3.0-or-later
// Time in the 3D view: playing, scrubbing and stepping, with the events of the moment in the camera's
// frustum.
#include "core/geometry/camera_model.h"
#include "tests/support/test_program.h"
#include "tests/ui/shown_trajectory.h"
#include "ui/scene/trajectory_tools.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QLabel>
#include <QMenu>
#include <QSignalSpy>
#include <QSlider>
#include <QToolButton>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestTrajectoryPlay : public QObject {
  Q_OBJECT

  Example example_;
  bool has_opengl_ = false;

  std::unique_ptr<TrajectoryScreen> shownScreen(const QSize& size = {1000, 650}) const {
    auto screen = makeScreen(example_, size);
    if (!screen) return nullptr;
    screen->show();
    screen->activateWindow();
    if (!QTest::qWaitForWindowActive(screen.get())) return nullptr;
    return screen;
  }
  double firstView_s() const { return example_.run->detections.cameras.front().views.front().time_s; }

 private slots:
  void initTestCase() {
    example_ = makeExample(5.0);
    QCOMPARE(example_.run->result.status, CalibrationStatus::Ok);
    has_opengl_ = hasOpenGl();
  }
  void init() { setPalette(false); }

  void keys_work_fromEveryFocus() {
    const auto screen = shownScreen();
    QVERIFY(screen);
    QSignalSpy selected(screen.get(), &TrajectoryScreen::timeSelected);
    for (QWidget* const focused :
         {static_cast<QWidget*>(screen->view()), static_cast<QWidget*>(screen->findChild<QSlider*>()),
          static_cast<QWidget*>(screen->findChild<QComboBox*>("time_speed"))}) {
      focused->setFocus();
      QTest::keyClick(focused, Qt::Key_Home);
      const double begin_s = screen->time_s();
      QTest::keyClick(focused, Qt::Key_End);
      const double end_s = screen->time_s();
      QVERIFY(begin_s < 0.5 && end_s > 4.5);
      QCOMPARE(selected.last().first().toDouble(), end_s);
      QTest::keyClick(focused, Qt::Key_Left);
      QVERIFY(screen->time_s() < end_s && screen->time_s() > end_s - 0.5);
      const double before_s = screen->time_s();
      QTest::keyClick(focused, Qt::Key_Right);
      QVERIFY(screen->time_s() > before_s);
      QTest::keyClick(focused, Qt::Key_Space);
      QVERIFY(screen->isPlaying());
      QTest::keyClick(focused, Qt::Key_Space);
      QVERIFY(!screen->isPlaying());
    }
  }

  void steps_goFromBoardViewToBoardView() {
    const auto screen = shownScreen();
    QVERIFY(screen);
    screen->setTime(firstView_s());
    QTest::keyClick(screen->view(), Qt::Key_Right);
    QCOMPARE(screen->time_s(), example_.run->detections.cameras.front().views[1].time_s);
    QTest::keyClick(screen->view(), Qt::Key_Left);
    QCOMPARE(screen->time_s(), firstView_s());
  }

  void playing_movesTheCamera_andTellsTheOthersWhereItStopped() {
    const auto screen = shownScreen();
    QVERIFY(screen);
    QSignalSpy selected(screen.get(), &TrajectoryScreen::timeSelected);
    screen->setTime(1.0);
    QTest::mouseClick(screen->findChild<QToolButton*>("time_play"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(screen->time_s() > 1.2, kWorkPatience_ms);
    QCOMPARE(selected.count(), 0);
    QTest::mouseClick(screen->findChild<QToolButton*>("time_play"), Qt::LeftButton);
    QVERIFY(!screen->isPlaying());
    QCOMPARE(selected.count(), 1);
    QCOMPARE(selected.last().first().toDouble(), screen->time_s());
    screen->setPlaying(true);
    screen->hide();
    QVERIFY(!screen->isPlaying());
  }

  void playing_endsAtTheEnd_andBeginsAgainAtTheStart() {
    const auto screen = shownScreen();
    QVERIFY(screen);
    QTest::keyClick(screen->view(), Qt::Key_End);
    const double end_s = screen->time_s();
    screen->setTime(end_s - 0.1);
    QTest::keyClick(screen->view(), Qt::Key_Space);
    QTRY_VERIFY_WITH_TIMEOUT(!screen->isPlaying(), kWorkPatience_ms);
    QCOMPARE(screen->time_s(), end_s);
    QTest::keyClick(screen->view(), Qt::Key_Space);
    QVERIFY(screen->isPlaying() && screen->time_s() < 0.5);
  }

  void slider_goesWhereItIsPressed_andFollowsTheCursor() {
    const auto screen = shownScreen();
    QVERIFY(screen);
    QSignalSpy selected(screen.get(), &TrajectoryScreen::timeSelected);
    auto* const slider = screen->findChild<QSlider*>();
    screen->setTime(0.7);
    const int at_0_7 = slider->value();
    QTest::mouseClick(slider, Qt::LeftButton, {}, {3 * slider->width() / 4, slider->height() / 2});
    QVERIFY2(std::abs(screen->time_s() - 3.75) < 0.25, qPrintable(QString::number(screen->time_s())));
    QVERIFY(selected.count() >= 1 && slider->value() > at_0_7);
  }

  void withoutPoses_thereIsNothingToPlay() {
    TrajectoryScreen screen;
    screen.setBoards(example_.session);
    QVERIFY(!screen.findChild<QSlider*>()->isEnabled());
    screen.setPlaying(true);
    QVERIFY(!screen.isPlaying());
  }

  // Events of an image corner, which must appear at that corner of the frustum.
  void events_areDrawnInTheFrustum() {
    if (!has_opengl_) QSKIP("OpenGL is not available");
    const auto screen = shownScreen({1200, 800});
    QVERIFY(screen);
    for (int k = 0; k < kSceneLayerCount; ++k)
      screen->setLayerVisible(static_cast<SceneLayer>(k), static_cast<SceneLayer>(k) == SceneLayer::Events);
    const auto count = [](const QImage& image, const QColor& colour) {
      int found = 0;
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
          found += distance(image.pixelColor(x, y), colour) < 12.0 ? 1 : 0;
      return found;
    };
    const int before = count(picture(screen->view()), theme().brighter);
    double begin_s = 0.0, end_s = 0.0;
    screen->setEventSource([&]() -> EventLookup {
      return {0, [&](double from_s, double to_s) {
                begin_s = from_s;
                end_s = to_s;
                std::vector<Event> events;
                for (std::uint16_t y = 0; y < 200; ++y)
                  for (std::uint16_t x = 0; x < 200; ++x) events.push_back({0, x, y, true});
                return events;
              }};
    });
    screen->setTime(1.5);
    QVERIFY(QTest::qWaitFor([&] { return !screen->busy(); }, kWorkPatience_ms));
    QVERIFY(begin_s < 1.5 && end_s > 1.5);
    const QImage with = picture(screen->view());
    QVERIFY2(count(with, theme().brighter) > before + 30, qPrintable(QString::number(before)));
    screen->setLayerVisible(SceneLayer::Events, false);
    QVERIFY(count(picture(screen->view()), theme().brighter) <= before);
  }

  void eventsOnTheImagePlane_goBackToTheirPixels() {
    const CameraIntrinsics lens = *example_.session.cameras.front().intrinsics;
    const std::vector<Event> events = {{0, 10, 20, true}, {1, 10, 20, false}, {2, 100, 90, true}};
    const std::vector<FrustumEvent> placed = onImagePlane(events, lens);
    QCOMPARE(placed.size(), 2U);
    QVERIFY(!placed.back().brighter);  // the newest at its pixel
    const auto pixel = project(lens, placed.back().at);
    QVERIFY(pixel && (*pixel - Eigen::Vector2d(10, 20)).norm() < 1e-3);
    QVERIFY(onImagePlane(events, std::nullopt).empty());
  }

  // At the remaining width of 1024 px with the side bar, and with an open dock.
  void nothing_isCutOrHidden_inNarrowWindows() {
    for (const int width : {820, 560, 400}) {
      const auto screen = shownScreen({width, 600});
      QVERIFY(screen);
      QCOMPARE(screen->width(), width);
      QCoreApplication::processEvents();
      std::vector<QRect> taken;
      int buttons = 0;
      for (QWidget* const each : screen->findChildren<QWidget*>()) {
        if (!each->isVisible()) continue;
        const auto* const button = qobject_cast<QToolButton*>(each);
        const auto* const label = qobject_cast<QLabel*>(each);
        if (button == nullptr && label == nullptr) continue;
        const QRect at(each->mapTo(screen.get(), QPoint()), each->size());
        QVERIFY2(screen->rect().contains(at), qPrintable(each->objectName()));
        if (label != nullptr)
          QVERIFY2(label->fontMetrics().horizontalAdvance(label->text().remove('&')) <= at.width(),
                   qPrintable(label->text()));
        if (button != nullptr) QVERIFY2(at.width() >= button->sizeHint().width(), qPrintable(button->text()));
        for (const QRect& other : taken) QVERIFY2(!other.intersects(at), qPrintable(each->accessibleName()));
        taken.push_back(at);
        buttons += button != nullptr ? 1 : 0;
      }
      QVERIFY(buttons >= 13);
      QVERIFY(screen->view()->height() > 300);
    }
  }
};

EVICAL_TEST(TestTrajectoryPlay)
#include "tst_trajectory_play.moc"
