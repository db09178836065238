// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/frontend/normal_flow.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "ui/detection/event_view.h"
#include "ui/detection/surface_frame.h"
#include "ui/theme/theme.h"

#include <QPainter>
#include <QTest>
#include <QWheelEvent>

#include <ctime>
#include <numeric>
#include <random>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr Resolution kSmall_px = {64, 48};
constexpr std::int64_t kNow_ns = 1'700'000'000'000'000'000;

SurfaceStyle style(SurfaceMode mode = SurfaceMode::Decayed) {
  return {mode, 0.01, qRgb(0, 0, 0), qRgb(255, 0, 0), qRgb(0, 0, 255)};
}

Event eventAt(std::uint16_t x, std::uint16_t y, double before_s, bool brighter) {
  return {kNow_ns - static_cast<std::int64_t>(before_s * 1e9), x, y, brighter};
}

std::shared_ptr<const SurfaceFrame> smallFrame() {
  const std::vector<Event> events = {eventAt(10, 12, 0.001, true), eventAt(20, 30, 0.002, false)};
  return std::make_shared<SurfaceFrame>(renderEvents(events, kNow_ns, kSmall_px, style()));
}

QList<QPointF> placesOf(const QImage& image, QRgb colour, int tolerance = 0) {
  QList<QPointF> places;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const QRgb pixel = image.pixel(x, y);
      const int off =
          std::max({std::abs(qRed(pixel) - qRed(colour)), std::abs(qGreen(pixel) - qGreen(colour)),
                    std::abs(qBlue(pixel) - qBlue(colour))});
      if (off <= tolerance) places << QPointF(x, y);
    }
  }
  return places;
}

void wheelForEventView(EventView& view, const QPointF& at, int steps) {
  QWheelEvent event(at, view.mapToGlobal(at), {}, {0, 120 * steps}, Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&view, &event);
}

std::vector<Event> manyEvents(Resolution resolution_px, int count) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> x(0, resolution_px.width_px - 1), y(0, resolution_px.height_px - 1);
  std::vector<Event> events;
  for (int k = 0; k < count; ++k) {
    const auto x_px = static_cast<std::uint16_t>(x(random)), y_px = static_cast<std::uint16_t>(y(random));
    events.push_back(eventAt(x_px, y_px, 0.05 * (1.0 - k / static_cast<double>(count)), k % 2 == 0));
  }
  return events;
}

}  // namespace

class TestEventView : public QObject {
  Q_OBJECT

 private slots:
  void decayed_fadesWithAgeAndShowsPolarity() {
    const std::vector<Event> events = {eventAt(1, 1, 0.0, true), eventAt(2, 1, 0.01, true),
                                       eventAt(3, 1, 0.06, true), eventAt(4, 1, 0.0, false)};
    const SurfaceFrame frame = renderEvents(events, kNow_ns, kSmall_px, style());
    QCOMPARE(frame.image.pixel(1, 1), qRgb(255, 0, 0));
    QVERIFY(std::abs(qRed(frame.image.pixel(2, 1)) - 94) <= 2);  // 255 / e
    QCOMPARE(frame.image.pixel(3, 1), qRgb(0, 0, 0));
    QCOMPARE(frame.image.pixel(4, 1), qRgb(0, 0, 255));
  }

  void legend_namesPolarities_whereThereIsRoom() {
    EventView view;
    view.setFrame(smallFrame());
    view.resize(640, 480);
    const QImage without = view.grab().toImage();
    view.setLegend(ColourLegend::Polarity);
    const QImage with = view.grab().toImage();
    QCOMPARE(placesOf(without, theme().brighter.rgb()).size(), 0);
    for (const QColor& colour : {theme().brighter, theme().darker})
      QVERIFY(placesOf(with, colour.rgb()).size() > 50);
    view.resize(200, 150);
    QCOMPARE(placesOf(view.grab().toImage(), theme().brighter.rgb()).size(), 0);
  }

  // Each colour of the wheel is in the direction in which an edge of that colour moves.
  void caption_isWhole_whereItIsWiderThanTheView() {
    const auto rowsUnderCaption = [](int width_px) {
      EventView view;
      view.resize(width_px, 400);
      view.setFrame(smallFrame());
      const QImage bare = view.grab().toImage();
      view.setCaption("left, 12.345 s to 12.360 s, 12 345 events, complete");
      const QImage image = view.grab().toImage();
      int rows = 0;
      bool at_the_edge = false;
      for (int y = 0; y < image.height(); ++y) {
        bool differs = false;
        for (int x = 0; x < image.width(); ++x) differs |= image.pixel(x, y) != bare.pixel(x, y);
        rows += differs;
        at_the_edge |= image.pixel(width_px - 1, y) != bare.pixel(width_px - 1, y);
      }
      return at_the_edge ? -1 : rows;
    };
    const int one_line_px = rowsUnderCaption(600);
    QVERIFY(one_line_px > 10);
    QVERIFY(rowsUnderCaption(250) > one_line_px + 10);
  }

  void legend_turnsAsTheFlowDoes() {
    EventView view;
    view.setFrame(smallFrame());
    view.resize(640, 480);
    view.setLegend(ColourLegend::Direction);
    const QImage with = view.grab().toImage();
    const auto middle = [&](double x, double y) {
      const QList<QPointF> places = placesOf(with, flowColour(x, y), 12);
      return std::accumulate(places.begin(), places.end(), QPointF()) / std::max(1.0, double(places.size()));
    };
    const QPointF right = middle(1, 0), left = middle(-1, 0), down = middle(0, 1), up = middle(0, -1);
    QVERIFY(right.x() > left.x() + 15.0 && down.y() > up.y() + 15.0);
    QVERIFY(std::abs(right.y() - left.y()) < 3.0 && std::abs(down.x() - up.x()) < 3.0);
  }

  void decayed_newestCountsWhateverTheOrder() {
    const std::vector<Event> events = {eventAt(5, 5, 0.001, false), eventAt(5, 5, 0.004, true)};
    const auto hit = renderEvents(events, kNow_ns, kSmall_px, style()).newestAt(5, 5);
    QVERIFY(hit.has_value());
    QVERIFY(!hit->brighter);
    QVERIFY(std::abs(hit->time_s + 0.001) < 1e-6);
  }

  void accumulated_mixesPolaritiesByNumber() {
    const std::vector<Event> events = {eventAt(1, 1, 0.0, true), eventAt(1, 1, 0.001, true),
                                       eventAt(1, 1, 0.002, false), eventAt(1, 1, 0.003, false)};
    const SurfaceFrame frame = renderEvents(events, kNow_ns, kSmall_px, style(SurfaceMode::Accumulated));
    const QRgb mixed = frame.image.pixel(1, 1);
    QVERIFY(qRed(mixed) > 50);
    QCOMPARE(qRed(mixed), qBlue(mixed));
  }

  void flow_hasTheHueOfItsDirection() {
    const NormalFlowField flow = {{7, 8, true, 0.0f, {100.0f, 0.0f}}, {9, 8, true, 0.0f, {-100.0f, 0.0f}}};
    const SurfaceFrame frame = renderFlow({}, flow, kNow_ns, kSmall_px, style(SurfaceMode::NormalFlow));
    QCOMPARE(QColor(frame.image.pixel(7, 8)).hsvHue(), 0);
    QCOMPARE(QColor(frame.image.pixel(9, 8)).hsvHue(), 180);
  }

  void wheel_keepsThePixelUnderTheMouse() {
    EventView view;
    view.resize(640, 480);
    view.setFrame(smallFrame());
    const QPointF at(200.0, 150.0);
    const QPointF before = view.sensorFromWidget(at);
    wheelForEventView(view, at, 6);
    QVERIFY(view.scale() > 30.0);
    QVERIFY((view.sensorFromWidget(at) - before).manhattanLength() < 1e-9);
    wheelForEventView(view, at, -40);
    QVERIFY(std::abs(view.scale() - 468.0 / 48.0) < 1e-9);  // never smaller than the fitted size
  }

  void drag_pansAndFFits() {
    EventView view;
    view.resize(640, 480);
    view.show();
    view.setFrame(smallFrame());
    view.fit();
    wheelForEventView(view, {320.0, 240.0}, 8);
    const QPointF before = view.sensorFromWidget({0.0, 0.0});
    QTest::mousePress(&view, Qt::LeftButton, {}, {300, 200});
    QTest::mouseMove(&view, {340, 230});
    QTest::mouseRelease(&view, Qt::LeftButton, {}, {340, 230});
    const QPointF moved = view.sensorFromWidget({0.0, 0.0}) - before;
    QVERIFY(std::abs(moved.x() + 40.0 / view.scale()) < 1e-9);
    QVERIFY(std::abs(moved.y() + 30.0 / view.scale()) < 1e-9);
    QTest::keyClick(&view, Qt::Key_F);
    QVERIFY(std::abs(view.scale() - 468.0 / 48.0) < 1e-9);
  }

  void hover_tellsPixelTimeAndPolarity() {
    EventView view;
    view.resize(640, 480);
    view.show();
    view.setFrame(smallFrame());
    QTest::mouseMove(&view, view.widgetFromSensor({10.0, 12.0}).toPoint());
    QVERIFY2(view.readout().contains("x 10  y 12"), qPrintable(view.readout()));
    QVERIFY2(view.readout().contains("-1.00 ms"), qPrintable(view.readout()));
    QVERIFY(view.readout().contains("brighter"));
    QTest::mouseMove(&view, view.widgetFromSensor({11.0, 12.0}).toPoint());
    QVERIFY(view.readout().contains("no event"));
  }

  void overlay_paintsInSensorPixels() {
    EventView view;
    view.resize(640, 480);
    view.setFrame(smallFrame());
    view.setOverlay(
        [](QPainter& painter, double) { painter.fillRect(QRectF(39.5, 9.5, 1.0, 1.0), QColor(0, 255, 0)); });
    const QImage image = view.grab().toImage();
    QCOMPARE(image.pixelColor(view.widgetFromSensor({40.0, 10.0}).toPoint()), QColor(0, 255, 0));
    QVERIFY(image.pixelColor(view.widgetFromSensor({41.5, 10.0}).toPoint()) != QColor(0, 255, 0));
  }

  // 33 ms of processor time for rendering (in a worker) and painting (in the window) together: 30 frames/s on
  // one core, at 5 million events per second.
  void frame_ofAnHdSensorTakesLessThanAThirtieth() {
    constexpr Resolution kHd_px = {1280, 720};
    const std::vector<Event> events = manyEvents(kHd_px, 250'000);
    EventView view;
    view.resize(1280, 720);
    QImage canvas(1280, 720, QImage::Format_RGB32);
    constexpr int kFrames = 10;
    const std::clock_t begin = std::clock();
    for (int k = 0; k < kFrames; ++k) {
      view.setFrame(std::make_shared<SurfaceFrame>(renderEvents(events, kNow_ns, kHd_px, style())));
      view.render(&canvas);
    }
    const double frame_ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kFrames;
    qInfo("%.1f ms per frame", frame_ms);
    QVERIFY(frame_ms < 33.0 * evical::ui::test::slowness());
  }
};

EVICAL_TEST(TestEventView)
#include "tst_event_view.moc"
