// SPDX-License-Identifier: GPL-3.0-or-later
// Display of twice the usual density: all custom drawing is sharp, and the mouse position is correct.
#include "tests/support/test_program.h"
#include "ui/detection/event_view.h"
#include "ui/detection/layers.h"
#include "ui/plots/plot_panel.h"
#include "ui/scene/view3d.h"
#include "ui/theme/theme.h"

#include <QApplication>
#include <QLabel>
#include <QMouseEvent>
#include <QPainter>
#include <QSignalSpy>
#include <QToolButton>

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

using namespace evical;
using namespace evical::ui;
using Eigen::Vector3d;

namespace {

constexpr int kDensity = 2;  // QT_SCALE_FACTOR, set in the ctest entry of this test

// Share of the picture's 2x2 blocks that are not of one colour: none in a picture that was enlarged.
double fineDetail(const QImage& image) {
  int mixed = 0, blocks = 0;
  for (int y = 0; y + 1 < image.height(); y += 2) {
    for (int x = 0; x + 1 < image.width(); x += 2, ++blocks) {
      const QRgb first = image.pixel(x, y);
      mixed += first != image.pixel(x + 1, y) || first != image.pixel(x, y + 1) ||
               first != image.pixel(x + 1, y + 1);
    }
  }
  return static_cast<double>(mixed) / blocks;
}

QImage pictureOf(QWidget& widget) {
  return widget.grab().toImage().convertToFormat(QImage::Format_RGB32);
}

void hover(QWidget& widget, const QPointF& at) {
  QMouseEvent move(QEvent::MouseMove, at, widget.mapToGlobal(at), Qt::NoButton, Qt::NoButton, Qt::NoModifier);
  QApplication::sendEvent(&widget, &move);
}

// A triangle in the plane z = 0.
vtkSmartPointer<vtkActor> makeTriangle() {
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(-0.2, -0.1, 0.0);
  points->InsertNextPoint(0.2, -0.07, 0.0);
  points->InsertNextPoint(0.03, 0.2, 0.0);
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({0, 1, 2});
  vtkNew<vtkPolyData> triangle;
  triangle->SetPoints(points);
  triangle->SetPolys(cells);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(triangle);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(1.0, 0.0, 0.0);
  return actor;
}

}  // namespace

class TestHighDpi : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    applyTheme(*qApp, Appearance::Light);
    QCOMPARE(QLabel().devicePixelRatioF(), static_cast<double>(kDensity));
  }

  void icons_areDrawnAtTheDisplaysDensity_data() {
    QTest::addColumn<QString>("name");
    for (const char* const name : {"calibrate", "detection", "trajectory", "parameters", "warning"})
      QTest::newRow(name) << QString(name);
  }
  void icons_areDrawnAtTheDisplaysDensity() {
    QFETCH(QString, name);
    const QPixmap pixmap = icon(name).pixmap(QSize(20, 20), static_cast<double>(kDensity));
    QCOMPARE(pixmap.size(), kDensity * QSize(20, 20));
    QCOMPARE(pixmap.deviceIndependentSize(), QSizeF(20.0, 20.0));
    QVERIFY(fineDetail(pixmap.toImage().convertToFormat(QImage::Format_ARGB32)) > 0.1);
    QToolButton button;
    button.setIcon(icon(name));
    button.setIconSize(QSize(24, 24));
    button.resize(40, 40);
    QCOMPARE(pictureOf(button).size(), kDensity * QSize(40, 40));
    QVERIFY(fineDetail(pictureOf(button)) > 0.04);
  }

  void eventView_pixelsAreWhereTheMouseFindsThem() {
    const std::vector<Event> events = {{999'000'000, 3, 2, true}};
    const SurfaceStyle style{SurfaceMode::Decayed, 0.01, qRgb(0, 0, 0), qRgb(255, 0, 0), qRgb(0, 0, 255)};
    EventView view;
    view.resize(413, 301);
    view.setFrame(std::make_shared<SurfaceFrame>(renderEvents(events, 1'000'000'000, {10, 8}, style)));
    const QImage image = pictureOf(view);
    QCOMPARE(image.size(), kDensity * view.size());
    // Just inside and just outside the pixel's four sides.
    constexpr double kInside = 0.45, kOutside = 0.55;
    for (const QPointF& side : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)}) {
      for (const double distance : {kInside, kOutside}) {
        const QPointF at = view.widgetFromSensor(QPointF(3, 2) + distance * side);
        const QColor drawn = image.pixelColor((kDensity * at).toPoint());
        hover(view, at);
        const bool on_it = distance == kInside;
        QVERIFY2((drawn.red() > 150) == on_it, qPrintable(drawn.name()));
        QCOMPARE(view.readout().startsWith("x 3  y 2 "), on_it);
      }
    }
  }

  void eventView_lettersAreSharp() {
    EventView view;
    view.resize(400, 300);
    view.setMessage("Opening the recording");
    QVERIFY(fineDetail(pictureOf(view)) > 0.005);
  }

  void layers_haveLinesOfOneWidthAtEveryDensity() {
    const auto inkAt = [](int density) {
      QImage image(density * QSize(200, 200), QImage::Format_RGB32);
      image.setDevicePixelRatio(density);
      image.fill(theme().panel);
      QPainter painter(&image);
      painter.setRenderHint(QPainter::Antialiasing);
      painter.scale(4.0, 4.0);
      LayerSet layers;
      layers.set(static_cast<std::size_t>(Layer::Reprojection));
      paintLayers(painter, 4.0, layers, nullptr, {QPolygonF(QRectF(10, 10, 25, 25))});
      painter.end();
      double ink = 0.0;
      for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x)
          ink += std::abs(image.pixelColor(x, y).red() - theme().panel.red());
      }
      return ink;
    };
    const double ratio = inkAt(kDensity) / inkAt(1);
    QVERIFY2(std::abs(ratio - kDensity * kDensity) < 0.4, qPrintable(QString::number(ratio)));
  }

  void plot_isSharp_andClicksHitTheirValues() {
    PlotPanel panel({.title = "Sine", .x_label = "time (s)", .y_label = "rad/s", .time = true});
    const auto series = panel.addSeries(PlotPanel::SeriesKind::Line, {.name = "x"});
    std::vector<double> x, y;
    for (int k = 0; k <= 500; ++k) {
      x.push_back(0.02 * k);
      y.push_back(std::sin(x.back()));
    }
    panel.setData(series, x, y);
    panel.resize(500, 320);
    panel.show();
    QVERIFY(QTest::qWaitForWindowExposed(&panel));
    panel.fit();
    panel.redraw();
    const QImage image = pictureOf(panel);
    QCOMPARE(image.size(), kDensity * panel.size());
    QVERIFY(fineDetail(image) > 0.02);
    const QPointF on_line = panel.pixelAt(4.7, std::sin(4.7));
    bool found = false;
    for (int dx = -2; dx <= 2; ++dx) {
      for (int dy = -2; dy <= 2; ++dy) {
        const QColor colour = image.pixelColor((kDensity * on_line).toPoint() + QPoint(dx, dy));
        found = found || (colour.blue() > colour.red() + 60);
      }
    }
    QVERIFY(found);
    QSignalSpy clicked(&panel, &PlotPanel::clicked);
    auto* const chart = panel.findChild<QWidget*>();
    QTest::mouseClick(chart, Qt::LeftButton, {}, chart->mapFromParent(on_line.toPoint()));
    QCOMPARE(clicked.count(), 1);
    QVERIFY(std::abs(clicked[0][0].toDouble() - 4.7) < 0.03);
  }

  void view3d_isSharp_andProjectsWhereItDraws() {
    View3D view;
    view.renderer()->AddActor(makeTriangle());
    view.setBackground(Qt::black);
    view.setWorld(-Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::Zero(), 0.3);
    view.look(StandardView::Front);
    view.resize(401, 299);
    const QImage image = pictureOf(view);
    if (!view.problem().isEmpty()) QSKIP("OpenGL is not available");
    QCOMPARE(image.size(), kDensity * view.size());
    QVERIFY(fineDetail(image) > 0.001);
    for (const auto& [point, drawn] : {std::pair{Vector3d(-0.17, -0.09, 0.0), true},
                                       {Vector3d(0.03, 0.18, 0.0), true},
                                       {Vector3d(-0.2, -0.13, 0.0), false},
                                       {Vector3d(0.03, 0.22, 0.0), false}}) {
      const auto at = view.project(point);
      QVERIFY(at);
      const QColor colour = image.pixelColor((kDensity * *at).toPoint());
      QCOMPARE(colour.red() > 128, drawn);
    }
    QSignalSpy clicked(&view, &View3D::clicked);
    QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(123, 77));
    QCOMPARE(clicked.at(0).at(0).toPointF(), QPointF(123, 77));
  }
};

EVICAL_TEST(TestHighDpi)
#include "tst_high_dpi.moc"
