// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/test_program.h"
#include "tests/ui/opengl.h"
#include "ui/scene/turntable_camera.h"
#include "ui/scene/view3d.h"

#include <QPainter>
#include <QProcess>
#include <QSignalSpy>
#include <QTest>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <cmath>
#include <memory>

using Eigen::Vector3d;
using evical::ui::StandardView;
using evical::ui::TurntableCamera;
using evical::ui::View3D;
using evical::ui::ViewPose;

namespace {

// A square of 0.4 m in the plane z = 0, around the origin.
vtkSmartPointer<vtkActor> makeSquare(const QColor& colour) {
  vtkNew<vtkPoints> points;
  for (const auto& [x, y] : {std::pair{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}}) {
    points->InsertNextPoint(x, y, 0.0);
  }
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({0, 1, 2, 3});
  vtkNew<vtkPolyData> square;
  square->SetPoints(points);
  square->SetPolys(cells);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(square);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(colour.redF(), colour.greenF(), colour.blueF());
  return actor;
}

struct SquareView {
  View3D view;

  SquareView() {
    view.renderer()->AddActor(makeSquare(Qt::red));
    view.setBackground(Qt::black);
    view.setWorld(-Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::Zero(), 0.4);
    view.look(StandardView::Front);
    view.resize(400, 300);
  }
  QImage image() { return view.grab().toImage().convertToFormat(QImage::Format_RGB32); }
};

int countPixels(const QImage& image, QRgb colour) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += image.pixel(x, y) == colour ? 1 : 0;
  }
  return count;
}

}  // namespace

class TestView3D : public QObject {
  Q_OBJECT

 private slots:
  void pose_ofStandardViews_looksAlongTheAxes();
  void orbit_keepsTheAxisUpright();
  void pan_movesThePictureByTheStepOnScreen();
  void project_agreesWithThePicture();
  void picture_followsTheSize();
  void picture_isTheSameAfterALongWay();
  void drag_turnsTheView();
  void dragWithRightButton_shiftsThePicture();
  void wheel_zooms();
  void keys_turnAndReset();
  void click_isNoDrag();
  void overlay_isPaintedOnTop();
  void views_comeAndGo();
  void withoutOpenGl_saysSo();
};

void TestView3D::pose_ofStandardViews_looksAlongTheAxes() {
  TurntableCamera camera;
  camera.setAxes(-Vector3d::UnitY(), Vector3d(0.0, 0.3, 1.0));
  camera.fit(Vector3d(1.0, 2.0, 3.0), 0.5, 1.5);
  const auto direction = [&](StandardView view) -> Vector3d {
    camera.look(view);
    return (camera.pose().focus_m - camera.pose().eye_m).normalized();
  };
  QVERIFY((direction(StandardView::Front) - Vector3d::UnitZ()).norm() < 1e-12);
  QVERIFY((direction(StandardView::Side) + Vector3d::UnitX()).norm() < 1e-12);
  QVERIFY((direction(StandardView::Top) - Vector3d::UnitY()).norm() < 1e-12);
  QVERIFY((camera.pose().up - Vector3d::UnitZ()).norm() < 1e-12);
}

void TestView3D::orbit_keepsTheAxisUpright() {
  TurntableCamera camera;
  camera.setAxes(Vector3d(0.1, -1.0, 0.2), Vector3d::UnitZ());
  camera.fit(Vector3d::Zero(), 0.5, 1.0);
  for (int k = 0; k < 200; ++k) {
    camera.orbit(0.37, 0.11 * std::sin(k));
    const ViewPose pose = camera.pose();
    const auto top = pose.project(0.1 * camera.up(), {400, 300});
    QVERIFY(top);
    QVERIFY(std::abs(top->x() - 200.0) < 1e-6);
    QVERIFY(top->y() < 150.0);
  }
}

void TestView3D::pan_movesThePictureByTheStepOnScreen() {
  TurntableCamera camera;
  camera.fit(Vector3d::Zero(), 0.5, 1.0);
  camera.orbit(0.5, 0.3);
  camera.pan(-0.1, 0.2);  // of a height of 300
  const auto at = camera.pose().project(Vector3d::Zero(), {400, 300});
  QVERIFY(at);
  QVERIFY(std::abs(at->x() - 230.0) < 1e-6);
  QVERIFY(std::abs(at->y() - 210.0) < 1e-6);
}

void TestView3D::project_agreesWithThePicture() {
  if (!evical::ui::test::hasOpenGl()) QSKIP("OpenGL is not available");
  SquareView square;
  square.view.look(StandardView::Home);
  const QImage image = square.image();
  for (double x = -0.3; x <= 0.31; x += 0.04) {
    for (double y = -0.3; y <= 0.31; y += 0.04) {
      if (std::abs(std::abs(x) - 0.2) < 0.01 || std::abs(std::abs(y) - 0.2) < 0.01) continue;
      const auto at = square.view.project({x, y, 0.0});
      QVERIFY(at);
      const bool inside = std::abs(x) < 0.2 && std::abs(y) < 0.2;
      QCOMPARE(QColor(image.pixel(at->toPoint())), QColor(inside ? Qt::red : Qt::black));
    }
  }
}

void TestView3D::picture_followsTheSize() {
  if (!evical::ui::test::hasOpenGl()) QSKIP("OpenGL is not available");
  SquareView square;
  const int small = countPixels(square.image(), qRgb(255, 0, 0));
  square.view.resize(800, 600);
  const QImage large = square.image();
  QCOMPARE(large.size(), QSize(800, 600));
  const double ratio = static_cast<double>(countPixels(large, qRgb(255, 0, 0))) / small;
  QVERIFY2(std::abs(ratio - 4.0) < 0.1, qPrintable(QString::number(ratio)));
}

void TestView3D::picture_isTheSameAfterALongWay() {
  if (!evical::ui::test::hasOpenGl()) QSKIP("OpenGL is not available");
  SquareView square;
  const QImage before = square.image();
  for (int k = 0; k < 5; ++k) QTest::keyClick(&square.view, Qt::Key_Left);
  QVERIFY(square.image() != before);
  QTest::keyClick(&square.view, Qt::Key_1);
  QCOMPARE(square.image(), before);
}

void TestView3D::drag_turnsTheView() {
  if (!evical::ui::test::hasOpenGl()) QSKIP("OpenGL is not available");
  SquareView square;
  QSignalSpy turned(&square.view, &View3D::turned);
  const QImage before = square.image();
  QTest::mousePress(&square.view, Qt::LeftButton, {}, {100, 100});
  QTest::mouseMove(&square.view, {150, 130});
  QTest::mouseMove(&square.view, {200, 160});
  QTest::mouseRelease(&square.view, Qt::LeftButton, {}, {200, 160});
  QVERIFY(turned.count() > 0);
  QVERIFY(square.image() != before);
  QVERIFY((square.view.viewPose().focus_m).norm() < 1e-12);
  const auto narrower = countPixels(square.image(), qRgb(255, 0, 0));
  QVERIFY(narrower < 0.9 * countPixels(before, qRgb(255, 0, 0)));
}

void TestView3D::dragWithRightButton_shiftsThePicture() {
  SquareView square;
  square.view.grab();
  const QPointF before = *square.view.project(Vector3d::Zero());
  QTest::mousePress(&square.view, Qt::RightButton, {}, {100, 100});
  QTest::mouseMove(&square.view, {160, 130});
  QTest::mouseRelease(&square.view, Qt::RightButton, {}, {160, 130});
  const QPointF moved = *square.view.project(Vector3d::Zero()) - before;
  QVERIFY(std::abs(moved.x() - 60.0) < 1e-6 && std::abs(moved.y() - 30.0) < 1e-6);
}

void TestView3D::wheel_zooms() {
  SquareView square;
  const auto distance = [&] {
    return (square.view.viewPose().focus_m - square.view.viewPose().eye_m).norm();
  };
  square.view.grab();
  const double before = distance();
  QWheelEvent event({50, 50}, square.view.mapToGlobal(QPointF(50, 50)), {}, {0, 240}, Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&square.view, &event);
  QVERIFY(distance() < 0.8 * before);
  QTest::keyClick(&square.view, Qt::Key_Minus);
  QTest::keyClick(&square.view, Qt::Key_Minus);
  QVERIFY(std::abs(distance() - before) < 1e-9);
}

void TestView3D::keys_turnAndReset() {
  SquareView square;
  square.view.grab();
  const Vector3d home = square.view.viewPose().eye_m;
  for (const Qt::Key key : {Qt::Key_Left, Qt::Key_Right, Qt::Key_Up, Qt::Key_Down, Qt::Key_2, Qt::Key_3}) {
    QTest::keyClick(&square.view, key);
    square.view.grab();
    QVERIFY2((square.view.viewPose().eye_m - home).norm() > 1e-3, qPrintable(QString::number(key)));
    QTest::keyClick(&square.view, Qt::Key_1);
    square.view.grab();
    QVERIFY((square.view.viewPose().eye_m - home).norm() < 1e-12);
  }
}

void TestView3D::click_isNoDrag() {
  SquareView square;
  QSignalSpy clicked(&square.view, &View3D::clicked), turned(&square.view, &View3D::turned);
  QTest::mouseClick(&square.view, Qt::LeftButton, {}, {120, 80});
  QCOMPARE(clicked.count(), 1);
  QCOMPARE(clicked.first().first().toPointF(), QPointF(120, 80));
  QTest::mousePress(&square.view, Qt::LeftButton, {}, {100, 100});
  QTest::mouseMove(&square.view, {150, 130});
  QTest::mouseRelease(&square.view, Qt::LeftButton, {}, {150, 130});
  QCOMPARE(clicked.count(), 1);
  QVERIFY(turned.count() > 0);
}

void TestView3D::overlay_isPaintedOnTop() {
  if (!evical::ui::test::hasOpenGl()) QSKIP("OpenGL is not available");
  SquareView square;
  square.view.setOverlay([](QPainter& painter) { painter.fillRect(QRect(195, 145, 10, 10), Qt::green); });
  const QImage image = square.image();
  QCOMPARE(QColor(image.pixel(200, 150)), QColor(Qt::green));
  QCOMPARE(QColor(image.pixel(190, 150)), QColor(Qt::red));
}

void TestView3D::views_comeAndGo() {
  if (!evical::ui::test::hasOpenGl()) QSKIP("OpenGL is not available");
  SquareView stays;
  const QImage before = stays.image();
  for (int k = 0; k < 20; ++k) {
    auto square = std::make_unique<SquareView>();
    QCOMPARE(square->image(), before);
  }
  QTest::keyClick(&stays.view, Qt::Key_2);
  QTest::keyClick(&stays.view, Qt::Key_1);
  QCOMPARE(stays.image(), before);
}

// In a separate process, since drivers are searched only once.
void TestView3D::withoutOpenGl_saysSo() {
  if (qEnvironmentVariable(evical::ui::test::kEglVendors) != evical::ui::test::kNoEglVendor) {
    QProcess process;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert(evical::ui::test::kEglVendors, evical::ui::test::kNoEglVendor);
    process.setProcessEnvironment(environment);
    process.start(QCoreApplication::applicationFilePath(), {"tst_view3d", "withoutOpenGl_saysSo"});
    QVERIFY(process.waitForFinished());
    QVERIFY2(process.exitStatus() == QProcess::NormalExit && process.exitCode() == 0,
             process.readAll().constData());
    return;
  }
  SquareView square;
  const QImage image = square.image();
  QVERIFY(!square.view.problem().isEmpty());
  QCOMPARE(countPixels(image, qRgb(255, 0, 0)), 0);
  const int background = countPixels(image, image.pixel(2, 2));
  QVERIFY2(image.width() * image.height() - background > 500, "text");
  QTest::keyClick(&square.view, Qt::Key_Left);
  QTest::mouseClick(&square.view, Qt::LeftButton, {}, {100, 100});
  square.view.resize(600, 500);
  QVERIFY(!square.image().isNull());
}

EVICAL_TEST(TestView3D)
#include "tst_view3d.moc"
