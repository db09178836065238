// SPDX-License-Identifier: GPL-3.0-or-later
// Frames on the detection screen: the picture at the cursor, the detections in it, or the reason for a
// missing board.
#include "core/base/time.h"
#include "core/frames/frame_options.h"
#include "core/frames/ideal_views.h"
#include "tests/support/rendered_board.h"
#include "tests/support/test_program.h"
#include "tests/ui/recorded_windows.h"
#include "tests/ui/screenshots.h"
#include "ui/detection/event_window_reader.h"
#include "ui/detection/frame_analysis.h"
#include "ui/detection/window_panel.h"
#include "ui/theme/theme.h"

#include <QComboBox>

#include <algorithm>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

constexpr std::size_t kDetectionFramesEvents = 0, kDetectionFramesFrames = 1;

// All frames of the recording, and queries on them.
struct DetectionFramesAsked {
  EventWindowReader reader;
  FrameQuestion question;

  explicit DetectionFramesAsked(const Recorded& recorded)
      : reader(recorded.session, kDetectionFramesFrames, recorded.folder.path().toStdString(), [] {}) {
    reader.read({});
    question.frames = reader.caches().frames;
    question.start_ns = reader.overview().start_ns;
    question.frames_read = question.frames->count();
    question.camera = "frames";
    question.board = recorded.session.board;
    question.frames_before = static_cast<std::size_t>(question.options.search_every_frames);
  }
  WindowAnalysis at(double time_s) {
    question.frame = *question.frames->nearest(question.start_ns + nanosecondsFrom(time_s));
    return analyseFrame(question);
  }
  // The same frames, each modified.
  void change(const std::string& folder, const std::function<void(Frame&)>& how) {
    auto changed = std::make_shared<FrameCache>(folder);
    for (std::size_t k = 0; k < question.frames->count(); ++k) {
      Frame frame = question.frames->frame(k);
      how(frame);
      changed->append(frame);
    }
    question.frames = changed;
  }
};

void settleFrame(DetectionScreen& screen) {
  QTRY_VERIFY_WITH_TIMEOUT(screen.framesInView() && screen.timeline().end_s() > 1.9, 20000 * kSlowdown);
  QTRY_VERIFY_WITH_TIMEOUT(screen.analysis() && screen.analysis()->frame &&
                               screen.analysis()->frame->settled && screen.view().frame() &&
                               screen.view().frame()->photograph &&
                               screen.analysis()->time_s == screen.view().frame()->time_s &&
                               std::abs(screen.analysis()->time_s - screen.time_s()) < 0.03,
                           20000 * kSlowdown);
}

}  // namespace

class TestDetectionFrames : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() { recorded_ = std::make_unique<Recorded>("davis346_frames"); }

  void cache_findsFramesByTheirTimes() {
    FrameCache cache(recorded_->folder.path().toStdString());
    QVERIFY(!cache.nearest(0));
    for (const std::int64_t time_ns : {100, 200, 200, 150, 300}) {
      Frame frame;
      frame.time_ns = time_ns;
      frame.bytes.assign(static_cast<std::size_t>(time_ns), static_cast<std::uint8_t>(time_ns % 251));
      cache.append(frame);
    }
    QCOMPARE(cache.count(), std::size_t{3});  // one twice, one late
    QCOMPARE(*cache.nearest(-5), std::size_t{0});
    QCOMPARE(*cache.nearest(149), std::size_t{0});
    QCOMPARE(*cache.nearest(151), std::size_t{1});
    QCOMPARE(*cache.nearest(999), std::size_t{2});
    const Frame last = cache.frame(2);
    QCOMPARE(last.time_ns, std::int64_t{300});
    QVERIFY(last.bytes == std::vector<std::uint8_t>(300, 300 % 251));
  }

  void reader_readsTheOtherKindAlong() {
    for (const std::size_t camera : {kDetectionFramesEvents, kDetectionFramesFrames}) {
      EventWindowReader reader(recorded_->session, camera, recorded_->folder.path().toStdString(), [] {});
      reader.read({});
      const RecordingOverview overview = reader.overview();
      QCOMPARE(overview.kind, camera == kDetectionFramesEvents ? CameraKind::Events : CameraKind::Frames);
      QCOMPARE(*overview.companion,
               camera == kDetectionFramesEvents ? kDetectionFramesFrames : kDetectionFramesEvents);
      QCOMPARE(overview.start_ns, recorded_->detections.start_ns);
      const RecordingCaches caches = reader.caches();
      QCOMPARE(caches.events->eventCount(), recorded_->detections.cameras[kDetectionFramesEvents].events);
      QVERIFY(std::abs(static_cast<double>(caches.frames->count()) - 40.0) <= 1.0);  // 2 s at 20 Hz
      QVERIFY(std::abs(overview.read_until_s - 2.0) < 0.06);
    }
  }

  // Tracked from as far back as in the run.
  void analysis_findsWhatTheRunFound() {
    DetectionFramesAsked asked(*recorded_);
    const BoardObservations& run = recorded_->detections.cameras[kDetectionFramesFrames];
    const CameraIntrinsics& lens = *recorded_->session.cameras[kDetectionFramesEvents].intrinsics;
    int views = 0, differing = 0;
    double furthest_px = 0.0;
    for (const WindowReport& window : run.windows) {
      const WindowAnalysis analysis = asked.at(window.time_s);
      QCOMPARE(analysis.time_s, window.time_s);
      QVERIFY(analysis.frame->due);
      differing += analysis.outcome != window.outcome;
      const auto view = std::find_if(run.views.begin(), run.views.end(),
                                     [&](const BoardView& v) { return v.time_s == window.time_s; });
      if (view == run.views.end()) continue;
      ++views;
      BoardObservations ours;
      ours.views = {{analysis.time_s, view->kind, analysis.points()}};
      ours = throughLens(std::move(ours), lens.resolution_px.height_px, lens);
      const auto& found = ours.views.front().circles;
      QCOMPARE(found.size(), view->circles.size());
      for (std::size_t k = 0; k < found.size(); ++k)
        furthest_px = std::max(furthest_px, (found[k].centre_px - view->circles[k].centre_px).norm());
    }
    qInfo("%zu windows, %d views, %d outcomes differ, points by %.2g px at most", run.windows.size(), views,
          differing, furthest_px);
    QVERIFY(views >= 5);
    QCOMPARE(differing, 0);
    QVERIFY(furthest_px < 1e-6);
  }

  void analysis_saysThatARunLeavesAFrameOut() {
    DetectionFramesAsked asked(*recorded_);
    int left_out = 0;
    for (asked.question.frame = 0; asked.question.frame < 10; ++asked.question.frame) {
      const WindowAnalysis analysis = analyseFrame(asked.question);
      const bool told = std::any_of(analysis.stages.begin(), analysis.stages.end(),
                                    [](const StageReport& stage) { return stage.stage == "rate"; });
      QCOMPARE(told, !analysis.frame->due);
      left_out += told;
    }
    QCOMPARE(left_out, 5);  // of 20 Hz, only 10 are needed
  }

  void analysis_tellsWhyAFrameHasNoBoard_data() {
    QTest::addColumn<std::function<void(Frame&)>>("frames");
    QTest::addColumn<WindowOutcome>("outcome");
    QTest::addColumn<QString>("stage");
    QTest::addColumn<bool>("points");
    using Change = std::function<void(Frame&)>;
    QTest::newRow("blurred") << Change([](Frame& frame) { frame.exposure_s = 0.4; }) << WindowOutcome::Blurred
                             << "blur" << true;
    QTest::newRow("damaged") << Change([](Frame& frame) {
      frame.format = FrameFormat::Encoded;
      frame.bytes = {'n', 'o', 'n', 'e'};
    }) << WindowOutcome::Unreadable
                             << "picture" << false;
    QTest::newRow("black") << Change([](Frame& frame) {
      frame.format = FrameFormat::Gray8;
      frame.size_px = {346, 260};
      frame.row_bytes = 346;
      frame.bytes.assign(346 * 260, 3);
    }) << WindowOutcome::NoLattice
                           << "search" << false;
  }
  void analysis_tellsWhyAFrameHasNoBoard() {
    QFETCH(std::function<void(Frame&)>, frames);
    QFETCH(WindowOutcome, outcome);
    QFETCH(QString, stage);
    QFETCH(bool, points);
    DetectionFramesAsked asked(*recorded_);
    QCOMPARE(asked.at(foundAt_s()).outcome,
             recorded_->detections.cameras[kDetectionFramesFrames].windows[foundWindow()].outcome);
    asked.change(recorded_->folder.path().toStdString(), frames);
    const WindowAnalysis analysis = asked.at(foundAt_s());
    QCOMPARE(analysis.outcome, outcome);
    QCOMPARE(!analysis.points().empty(), points);
    const auto failed = std::find_if(analysis.stages.rbegin(), analysis.stages.rend(),
                                     [](const auto& s) { return s.verdict == StageVerdict::Failed; });
    QVERIFY(failed != analysis.stages.rend());
    QCOMPARE(QString::fromStdString(failed->stage), stage);
  }

  void analysis_tellsHowTagsDifferFromUsualOnes() {
    evical::PrintedBoard printed;
    printed.board.type = BoardType::AprilGrid;
    printed.board.rows = printed.board.cols = 4;
    printed.board.spacing_m = 0.1;
    printed.board.tag_size_m = 0.075;
    printed.board.radius_m = 0.0;
    printed.clockwise_turns = 1;
    const GrayImage picture = renderBoard(printed, distortingCamera(), lookAt(printed.board, 0.6, {}), {});
    DetectionFramesAsked asked(*recorded_);
    asked.question.board = printed.board;
    asked.change(recorded_->folder.path().toStdString(), [&](Frame& frame) {
      frame.format = FrameFormat::Gray8;
      frame.size_px = picture.size_px;
      frame.row_bytes = static_cast<std::size_t>(picture.size_px.width_px);
      frame.bytes = picture.pixels;
    });
    const WindowAnalysis analysis = asked.at(foundAt_s());
    QCOMPARE(analysis.outcome, WindowOutcome::Complete);
    const auto said = std::find_if(analysis.stages.begin(), analysis.stages.end(),
                                   [](const StageReport& stage) { return stage.stage == "print"; });
    QVERIFY(said != analysis.stages.end());
    QVERIFY2(said->text.find("rotated by 90 deg clockwise") != std::string::npos, said->text.c_str());
  }

  void screen_showsTheFrameAtTheCursorAndItsPoints() {
    DetectionScreen screen;
    open(screen);
    screen.setTime(foundAt_s());
    settleFrame(screen);
    const WindowAnalysis& analysis = *screen.analysis();
    QCOMPARE(analysis.time_s, foundAt_s());
    QCOMPARE(screen.view().frame()->image.size(), QSize(346, 260));
    QVERIFY(analysis.points().size() > 10);
    QVERIFY2(screen.panel().text().contains("346 x 260 px"), qPrintable(screen.panel().text()));
    QVERIFY(screen.panel().text().contains("In the last run: "));
    screen.setLayerVisible(Layer::Centres, false);
    const int without = pixelsOf(screen.view().grab().toImage(), theme().bad);
    screen.setLayerVisible(Layer::Centres, true);
    QVERIFY(pixelsOf(screen.view().grab().toImage(), theme().bad) > without + 50);
  }

  void screen_stepsFromFrameToFrame() {
    DetectionScreen screen;
    open(screen);
    settleFrame(screen);
    screen.setTime(0.5);  // of no frame
    const auto number = [&] { return screen.view().frame()->photograph->number; };
    settleFrame(screen);
    const std::size_t first = number();
    for (std::size_t k = 1; k <= 3; ++k) {
      screen.step(+1);
      QTRY_COMPARE_WITH_TIMEOUT(number(), first + k, 5000 * kSlowdown);
      QCOMPARE(screen.view().frame()->time_s, screen.time_s());
    }
    screen.step(-1);
    QTRY_COMPARE_WITH_TIMEOUT(number(), first + 2, 5000 * kSlowdown);
  }

  void options_takeEffectOnTheFrameInView() {
    DetectionScreen screen;
    open(screen);
    screen.setTime(foundAt_s());
    settleFrame(screen);
    const std::size_t points = screen.analysis()->points().size();
    Session edited = recorded_->session;
    edited.options.frames.edit().min_sigma_px = 1.5;
    screen.setSession(edited);
    const auto sigma_px = [&] {
      return std::sqrt(0.5 * screen.analysis()->points().front().covariance_px2.trace());
    };
    QTRY_VERIFY_WITH_TIMEOUT(sigma_px() > 1.4, 20000 * kSlowdown);
    QCOMPARE(screen.analysis()->points().size(), points);
    edited.board.rows += 4;
    screen.setRun(nullptr, edited);
    screen.setSession(edited);
    QTRY_COMPARE_WITH_TIMEOUT(screen.analysis()->outcome, WindowOutcome::NoLattice, 20000 * kSlowdown);
  }

  void controlsOfEvents_areGoneWhileFramesAreInView() {
    DetectionScreen screen;
    open(screen);
    settleFrame(screen);
    const auto modes = [&] {
      const auto boxes = screen.findChildren<QComboBox*>();
      return *std::find_if(boxes.begin(), boxes.end(),
                           [](const QComboBox* box) { return box->findText("Time surface") >= 0; });
    };
    QVERIFY(!modes()->isVisible());
    screen.setCamera(kDetectionFramesEvents);
    QTRY_VERIFY_WITH_TIMEOUT(screen.view().frame() && !screen.view().frame()->photograph, 20000 * kSlowdown);
    QVERIFY(modes()->isVisible());
    QTRY_VERIFY_WITH_TIMEOUT(screen.analysis() && !screen.analysis()->frame, 20000 * kSlowdown);
  }

  void screenshots_data() {
    QTest::addColumn<bool>("dark");
    QTest::newRow("light") << false;
    QTest::newRow("dark") << true;
  }
  void screenshots() {
    QFETCH(bool, dark);
    applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
    DetectionScreen screen;
    open(screen);
    screen.setTime(foundAt_s());
    settleFrame(screen);
    QVERIFY(screen.grab().save(screenshotPath("detection_frame_%1.png").arg(QTest::currentDataTag())));
    applyTheme(*qApp, Appearance::Light);
  }

 private:
  void open(DetectionScreen& screen) const {
    screen.resize(1280, 800);
    screen.show();
    screen.setSession(recorded_->session);
    screen.setRun(recorded_->run(), recorded_->session);
    screen.setCamera(kDetectionFramesFrames);
  }
  // The last one in which the run detected the board.
  std::size_t foundWindow() const {
    const BoardObservations& seen = recorded_->detections.cameras[kDetectionFramesFrames];
    for (std::size_t k = 0; k < seen.windows.size(); ++k) {
      if (seen.windows[k].time_s == seen.views.back().time_s) return k;
    }
    qFatal("the run saw no board in frames");
  }
  double foundAt_s() const {
    return recorded_->detections.cameras[kDetectionFramesFrames].windows[foundWindow()].time_s;
  }

  std::unique_ptr<Recorded> recorded_;
};

EVICAL_TEST(TestDetectionFrames)
#include "tst_detection_frames.moc"
