// SPDX-License-Identifier: GPL-3.0-or-later
// Events drawn over a frame through a calibration: the transfer of one pixel, and the picture of a rig.
#include "core/base/time.h"
#include "core/frames/frame_options.h"
#include "core/geometry/camera_model.h"
#include "tests/support/test_program.h"
#include "tests/ui/recorded_windows.h"
#include "tests/ui/screenshots.h"
#include "ui/detection/detection_engine.h"
#include "ui/detection/events_over_frame.h"
#include "ui/detection/frame_analysis.h"
#include "ui/detection/trajectory_pose.h"
#include "ui/theme/theme.h"

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

constexpr std::size_t kEventsOverFrameEvents = 0, kEventsOverFrameFrames = 1;

const CameraIntrinsics kEventLens{
    CameraModel::PinholeRadtan, {346, 260}, {262.0, 263.0}, {172.0, 131.0}, {-0.3, 0.1, 0.0006, -0.0004}};
const CameraIntrinsics kFrameLens{
    CameraModel::PinholeRadtan, {1280, 1024}, {900.0, 901.0}, {640.0, 512.0}, {-0.08, 0.05, 0.0, 0.0}};

// Two cameras in front of the board that sway and rotate for two seconds, with separate clocks.
CalibrationState swayingState(double line_delay_us) {
  CalibrationState state;
  state.world_from_imu_rotation = makeUniformSo3Spline(0.0, 2.0, 0.1);
  auto& rotations = state.world_from_imu_rotation.control_points;
  state.imu_in_world_m.start_s = state.world_from_imu_rotation.start_s;
  state.imu_in_world_m.knot_spacing_s = state.world_from_imu_rotation.knot_spacing_s;
  for (std::size_t k = 0; k < rotations.size(); ++k) {
    const double phase = 0.7 * static_cast<double>(k);
    rotations[k] = Eigen::Quaterniond(
        Eigen::AngleAxisd(0.05 * std::sin(phase), Eigen::Vector3d(1.0, 0.5, 0.3).normalized()));
    state.imu_in_world_m.control_points.emplace_back(0.15 + 0.05 * std::cos(phase), 0.25, -0.9);
  }
  state.cameras.resize(2);
  state.cameras[kEventsOverFrameEvents].lens = givenLens(kEventLens);
  state.cameras[kEventsOverFrameEvents].time_offset_s = 0.004;
  state.cameras[kEventsOverFrameFrames].lens = givenLens(kFrameLens);
  state.cameras[kEventsOverFrameFrames].time_offset_s = -0.021;
  state.cameras[kEventsOverFrameFrames].line_delay_us = line_delay_us;
  state.cameras[kEventsOverFrameFrames].reference_from_camera = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitY())), {0.06, -0.02, 0.01}};
  return state;
}

// Pixel at which the frame camera sees the point, in the row that is exposed at that time.
Eigen::Vector2d seenInFrame(const CalibrationState& state, const Eigen::Vector3d& point, double time_s) {
  const CameraState& camera = state.cameras[kEventsOverFrameFrames];
  Eigen::Vector2d pixel = *project(kFrameLens, *cameraFromWorldAt(state, camera, time_s) * point);
  for (int k = 0; k < 5; ++k) {
    const double row_time_s = time_s + 1e-6 * camera.line_delay_us * (pixel.y() - 511.5);
    pixel = *project(kFrameLens, *cameraFromWorldAt(state, camera, row_time_s) * point);
  }
  return pixel;
}

// Interpolated between the four pixels around a position.
std::optional<Eigen::Vector2d> carried(EventsOverFrame& transfer, const Eigen::Vector2d& at_px,
                                       double time_s) {
  const int x = static_cast<int>(std::floor(at_px.x())), y = static_cast<int>(std::floor(at_px.y()));
  const double u = at_px.x() - x, v = at_px.y() - y;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
    const auto corner = transfer.pixelOf(x + dx, y + dy, time_s);
    if (!corner) return std::nullopt;
    sum += (dx == 1 ? u : 1.0 - u) * (dy == 1 ? v : 1.0 - v) * *corner;
  }
  return sum;
}

double slope(const GrayImage& image, const Eigen::Vector2d& at_px) {
  const auto x = static_cast<std::size_t>(std::lround(at_px.x()));
  const auto y = static_cast<std::size_t>(std::lround(at_px.y()));
  const auto width = static_cast<std::size_t>(image.size_px.width_px);
  const auto level = [&](std::size_t k) { return static_cast<double>(image.pixels[k]); };
  const std::size_t k = y * width + x;
  return std::hypot(level(k + 1) - level(k - 1), level(k + width) - level(k - width));
}

}  // namespace

class TestEventsOverFrame : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    recorded_ = std::make_unique<Recorded>("davis346_frames", 5.0);
    recorded_->session.options.frames.edit().rate_hz = 20.0;
    run_ = std::make_shared<CalibrationRun>(calibrate(recorded_->session, {}));
  }

  void event_liesWhereTheFrameCameraSeesTheSamePointOfTheBoard_data() {
    QTest::addColumn<double>("line_delay_us");
    QTest::newRow("global shutter") << 0.0;
    QTest::newRow("rolling shutter") << 20.0;
  }
  void event_liesWhereTheFrameCameraSeesTheSamePointOfTheBoard() {
    QFETCH(double, line_delay_us);
    const auto state = std::make_shared<CalibrationState>(swayingState(line_delay_us));
    EventsOverFrame transfer(state, kEventsOverFrameEvents, kEventsOverFrameFrames, kEventLens.resolution_px);
    QCOMPARE(transfer.pixelsOfEvent(), 3);  // 900 of 262
    int compared = 0;
    for (double frame_time_s = 0.4; frame_time_s < 1.6; frame_time_s += 0.3) {
      transfer.setFrameTime(frame_time_s);
      for (const double before_s : {0.0, 0.0203, 0.0501}) {  // whole steps between poses
        const double time_s = std::round(1e4 * (transfer.eventTime_s(frame_time_s) - before_s)) * 1e-4;
        const auto camera_from_world =
            *cameraFromWorldAt(*state, state->cameras[kEventsOverFrameEvents], time_s);
        for (const double x_m : {0.0, 0.1, 0.25}) {
          const Eigen::Vector3d point(x_m, 1.5 * x_m, 0.0);
          const auto at_px = project(kEventLens, camera_from_world * point);
          QVERIFY(at_px);
          const auto there = carried(transfer, *at_px, time_s);
          QVERIFY(there);
          // A step of the rolling shutter is applied once.
          const double distance_px = (*there - seenInFrame(*state, point, frame_time_s)).norm();
          QVERIFY2(distance_px < 0.05, qPrintable(QString::number(distance_px)));
          ++compared;
        }
      }
    }
    QCOMPARE(compared, 36);
  }

  void event_withoutTrajectoryOrPlane_isNowhere() {
    auto state = std::make_shared<CalibrationState>(swayingState(0.0));
    EventsOverFrame transfer(state, kEventsOverFrameEvents, kEventsOverFrameFrames, kEventLens.resolution_px);
    transfer.setFrameTime(1.0);
    QVERIFY(transfer.pixelOf(170, 130, 1.0));
    QVERIFY(!transfer.pixelOf(170, 130, 7.0));
    transfer.setFrameTime(7.0);
    QVERIFY(!transfer.pixelOf(170, 130, 1.0));
    state->cameras[kEventsOverFrameFrames].lens = {};
    QVERIFY(!EventsOverFrame::isPossible(*state, kEventsOverFrameEvents, kEventsOverFrameFrames));
  }

  // Events within the board coincide with the frame's edges; with a wrong time offset they do not.
  void events_lieOnTheFramesEdges() {
    const double right = meanSlope(0.0);
    const double late = meanSlope(0.06), early = meanSlope(-0.06);
    qInfo("mean slope %.1f of 255 per pixel; %.1f and %.1f with offset errors of 60 ms", right, late, early);
    QVERIFY(right > 1.5 * std::max(late, early));
  }

  void screen_saysWhyThereIsNoOverlay() {
    DetectionScreen screen;
    open(screen, nullptr);
    screen.setCamera(kEventsOverFrameFrames);
    settle(screen);
    QVERIFY2(screen.whyNoOverlay().startsWith("Calibrate first"), qPrintable(screen.whyNoOverlay()));
    screen.setPicture(PictureChoice::Overlaid);
    QTest::qWait(200);
    QCOMPARE(screen.view().frame()->events, std::size_t{0});
    screen.setRun(run_, recorded_->session);
    QCOMPARE(screen.whyNoOverlay(), QString());
    screen.setCamera(kEventsOverFrameEvents);
    QTRY_VERIFY_WITH_TIMEOUT(screen.whyNoOverlay().startsWith("Choose the frame camera"), 20000 * kSlowdown);
  }

  void screen_showsBothKinds_data() {
    QTest::addColumn<std::size_t>("camera");
    QTest::newRow("frames first") << kEventsOverFrameFrames;
    QTest::newRow("events first") << kEventsOverFrameEvents;
  }
  void screen_showsBothKinds() {
    QFETCH(std::size_t, camera);
    DetectionScreen screen;
    open(screen, run_);
    screen.setCamera(camera);
    settle(screen);
    QVERIFY(!screen.companionView().isVisible());
    screen.setPicture(PictureChoice::SideBySide);
    QTRY_VERIFY_WITH_TIMEOUT(screen.companionView().isVisible() && screen.companionView().frame(),
                             20000 * kSlowdown);
    QCOMPARE(screen.companionView().frame()->photograph.has_value(), camera == kEventsOverFrameEvents);
    QCOMPARE(screen.view().frame()->photograph.has_value(), camera == kEventsOverFrameFrames);
    const double offset_s = run_->result.state.cameras[kEventsOverFrameFrames].time_offset_s -
                            run_->result.state.cameras[kEventsOverFrameEvents].time_offset_s;
    const double apart_s = screen.companionView().frame()->time_s - screen.view().frame()->time_s;
    if (camera == kEventsOverFrameFrames) QVERIFY(std::abs(apart_s - offset_s) < 1e-6);
    if (camera == kEventsOverFrameEvents)
      QVERIFY(std::abs(apart_s + offset_s) < 0.026);  // the nearest of 20 Hz
    screen.setPicture(PictureChoice::Alone);
    QVERIFY(!screen.companionView().isVisible());
  }

  void screen_drawsEventsOverTheFrame() {
    DetectionScreen screen;
    open(screen, run_);
    screen.setCamera(kEventsOverFrameFrames);
    settle(screen);
    screen.setPicture(PictureChoice::Overlaid);
    QTRY_VERIFY_WITH_TIMEOUT(screen.view().frame()->events > 1000, 20000 * kSlowdown);
    const QImage& image = screen.view().frame()->image;
    int coloured = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) coloured += QColor(image.pixel(x, y)).saturation() > 60;
    }
    QVERIFY2(coloured > 1000, qPrintable(QString::number(coloured)));
  }

  void screenshots_data() {
    QTest::addColumn<bool>("dark");
    QTest::addColumn<QSize>("size");
    QTest::newRow("light") << false << QSize(1100, 700);
    QTest::newRow("dark_hd") << true << QSize(1700, 950);
  }
  void screenshots() {
    QFETCH(bool, dark);
    QFETCH(QSize, size);
    applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
    DetectionScreen screen;
    open(screen, run_);
    screen.resize(size);
    screen.setCamera(kEventsOverFrameFrames);
    screen.setLayerVisible(Layer::Grid, false);
    screen.setLayerVisible(Layer::Ellipses, false);
    settle(screen);
    const auto save = [&](const QString& name) {
      QTest::qWait(500);
      return screen.grab().save(screenshotPath("%1_%2.png").arg(name, QTest::currentDataTag()));
    };
    screen.setPicture(PictureChoice::Overlaid);
    QVERIFY(save("detection_overlaid"));
    screen.setPicture(PictureChoice::SideBySide);
    screen.setLayerVisible(Layer::Reprojection, true);
    QVERIFY(save("detection_beside"));
    applyTheme(*qApp, Appearance::Light);
  }

 private:
  void open(DetectionScreen& screen, std::shared_ptr<const CalibrationRun> run) const {
    screen.resize(1280, 800);
    screen.show();
    screen.setSession(recorded_->session);
    screen.setRun(std::move(run), recorded_->session);
  }
  static void settle(DetectionScreen& screen) {
    QTRY_VERIFY_WITH_TIMEOUT(screen.timeline().end_s() > 1.9, 20000 * kSlowdown);
    screen.setTime(1.5);
    QTRY_VERIFY_WITH_TIMEOUT(
        screen.view().frame() && std::abs(screen.view().frame()->time_s - 1.5) < 0.03 && screen.analysis(),
        20000 * kSlowdown);
  }

  // Edge strength of frames at the events of the 20 ms before each, within the board's points, with an error
  // of the frames' time offset.
  double meanSlope(double offset_error_s) const {
    EventWindowReader reader(recorded_->session, kEventsOverFrameFrames,
                             recorded_->folder.path().toStdString(), [] {});
    reader.read({});
    const RecordingCaches caches = reader.caches();
    const std::int64_t start_ns = reader.overview().start_ns;
    auto state = std::make_shared<CalibrationState>(run_->result.state);
    state->cameras[kEventsOverFrameFrames].time_offset_s += offset_error_s;
    EventsOverFrame transfer(state, kEventsOverFrameEvents, kEventsOverFrameFrames, caches.events_px);
    double sum = 0.0;
    std::size_t count = 0;
    for (const BoardView& view : run_->detections.cameras[kEventsOverFrameFrames].views) {
      if (view.time_s < 0.3 || view.time_s > 1.7) continue;
      const GrayImage image = decodeFrame(
          caches.frames->frame(*caches.frames->nearest(start_ns + nanosecondsFrom(view.time_s))), "frame");
      transfer.setFrameTime(view.time_s);
      const std::int64_t until_ns = start_ns + nanosecondsFrom(transfer.eventTime_s(view.time_s));
      std::vector<Event> events;
      caches.events->gather(until_ns - 20'000'000, until_ns, events);
      const QRectF board = boundsOf(view);
      for (const Event& event : events) {
        const auto at_px = transfer.pixelOf(event.x_px, event.y_px, secondsSince(start_ns, event.time_ns));
        if (!at_px || !board.contains(QPointF(at_px->x(), at_px->y()))) continue;
        sum += slope(image, *at_px);
        ++count;
      }
    }
    return sum / static_cast<double>(count);
  }
  static QRectF boundsOf(const BoardView& view) {
    QPolygonF points;
    for (const CircleObservation& point : view.circles)
      points << QPointF(point.centre_px.x(), point.centre_px.y());
    return points.boundingRect().intersected(QRectF(2, 2, 340, 254));
  }

  std::unique_ptr<Recorded> recorded_;
  std::shared_ptr<const CalibrationRun> run_;
};

EVICAL_TEST(TestEventsOverFrame)
#include "tst_events_over_frame.moc"
