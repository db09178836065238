// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/detection_screen.h"

#include "core/base/file_places.h"
#include "core/frames/frame_options.h"
#include "core/frontend/detection_options.h"
#include "ui/detection/detection_engine.h"
#include "ui/detection/event_view.h"
#include "ui/detection/second_camera.h"
#include "ui/detection/timeline.h"
#include "ui/detection/window_list.h"
#include "ui/detection/window_list_model.h"
#include "ui/detection/window_panel.h"
#include "ui/forms/page_keys.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QEvent>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::ui {
namespace {

constexpr int kFrame_ms = 25;  // frames are dropped under load

// True if both sessions read the same events. If neither session nor recording has a resolution, the lens
// determines it; an unknown one does not contradict another.
bool sameEvents(const Session& a, const Session& b) {
  const auto same_source = [](const auto& x, const auto& y) {
    return x.stream == y.stream && x.recording == y.recording && x.clock_offset_s == y.clock_offset_s;
  };
  const auto same_size = [](const auto& x, const auto& y) {
    return !x || !y || !x->resolution_px.known() || !y->resolution_px.known() ||
           x->resolution_px == y->resolution_px;
  };
  const auto same_camera = [&](const SessionCamera& x, const SessionCamera& y) {
    return same_source(x, y) && x.resolution_px == y.resolution_px && same_size(x.intrinsics, y.intrinsics);
  };
  const auto same_imu = [&](const SessionImu& x, const SessionImu& y) {
    return same_source(x, y) && x.accelerometer_stream == y.accelerometer_stream &&
           x.angular_rate_unit == y.angular_rate_unit;
  };
  return a.recording == b.recording && a.reference == b.reference &&
         std::equal(a.cameras.begin(), a.cameras.end(), b.cameras.begin(), b.cameras.end(), same_camera) &&
         std::equal(a.imus.begin(), a.imus.end(), b.imus.begin(), b.imus.end(), same_imu);
}

}  // namespace

DetectionScreen::~DetectionScreen() = default;

void DetectionScreen::connectEngine() {
  engine_ = std::make_unique<DetectionEngine>();
  live_detection_ = new LiveDetection(this);
  connect(engine_.get(), &DetectionEngine::overviewChanged, this, &DetectionScreen::takeOverview);
  connect(engine_.get(), &DetectionEngine::frameReady, this, &DetectionScreen::takeFrame);
  connect(engine_.get(), &DetectionEngine::analysisReady, this, &DetectionScreen::takeAnalysis);
  connectPictures();
  look_for_ = new QPushButton(icon("search"), tr("Find the recording..."), view_);
  look_for_->setAccessibleName(tr("Find the recording"));
  look_for_->setToolTip(tr("Choose the new place of the recording; the run's data are kept"));
  look_for_->hide();
  auto* const over_view = new QVBoxLayout(view_);
  over_view->addStretch(3);
  over_view->addWidget(look_for_, 0, Qt::AlignHCenter);
  over_view->addStretch(1);
  connect(look_for_, &QPushButton::clicked, this, [this] { emit recordingWanted(missingRecording()); });
  connect(live_detection_, &LiveDetection::windowReady, this,
          [this] { showLiveFrame(live_detection_->take()); });
  connect(timeline_, &Timeline::timeSelected, this, [this](double time_s) {
    following_ = false;
    follow_button_->setChecked(false);
    select(time_s);
  });
  connect(&timer_, &QTimer::timeout, this, &DetectionScreen::advance);
  timer_.setTimerType(Qt::PreciseTimer);
  constexpr int kReadable_ms = 400;
  panel_timer_.setSingleShot(true);
  panel_timer_.setInterval(kReadable_ms);
  connect(&panel_timer_, &QTimer::timeout, this, &DetectionScreen::refreshPanel);
}

void DetectionScreen::setSession(const Session& session) {
  const bool lens_may_help = !engine_->overview().error.empty();
  const bool same = session_ && sameEvents(*session_, session) &&
                    !(lens_may_help && givenLenses(*session_) != givenLenses(session));
  session_ = session;
  options_ = *session.options.front_end;
  engine_->setOptions(options_, *session.options.frames);
  timeline_->setUsedRange(session.time_range_s);
  if (same) {
    engine_->setSight(detectionSetupOf(camera_));
    request();
    return;
  }
  const QSignalBlocker quiet(camera_box_);
  camera_box_->clear();
  for (const SessionCamera& camera : session.cameras)
    camera_box_->addItem(QString::fromStdString(camera.name));
  camera_box_->setVisible(session.cameras.size() > 1);
  time_s_ = 0.1;
  time_is_chosen_ = false;
  chooseCamera(0);
}

void DetectionScreen::readAgain() {
  if (session_) chooseCamera(camera_);
}

void DetectionScreen::chooseCamera(std::size_t camera) {
  camera_ = camera;
  look_for_->hide();
  analysis_.reset();
  companion_.reset();
  second_.reset();
  second_camera_->close();
  adaptTo(CameraKind::Events);
  offerPictures();
  view_->setFrame(nullptr);
  companion_view_->setFrame(nullptr);
  timeline_->setRange(0.0, 0.0);
  timeline_->setEventRate({});
  timeline_->setRotationRate({});
  if (session_ && camera < session_->cameras.size()) engine_->open(*session_, camera);
  showRun();
  view_->setMessage(session_ ? tr("Opening the recording ...")
                             : tr("No recording: open one to see its events"));
  refresh();
}

void DetectionScreen::setRun(std::shared_ptr<const CalibrationRun> run, const Session& session) {
  run_ = std::move(run);
  run_session_ = session;
  showRun();
  if (runInView() != nullptr) goWhereSeen(run_->detections.cameras);
}

// Until the user chooses a time: one with the board is better than the recording's start or, after following,
// its end.
void DetectionScreen::goWhereSeen(std::span<const BoardObservations> cameras) {
  if (time_is_chosen_ || following() || camera_ >= cameras.size()) return;
  const std::optional<double> seen_s = middleOfSeen_s(cameras[camera_].windows);
  if (!seen_s) return;
  moveTo(*seen_s);
  emit timeSelected(time_s_);
}

const CalibrationRun* DetectionScreen::runInView() const {
  const bool here = run_ && session_ && sameEvents(run_session_, *session_);
  return here && camera_ < run_->detections.cameras.size() ? run_.get() : nullptr;
}

// A run's detections belong to its own board and lens.
DetectionSetup DetectionScreen::detectionSetupOf(std::size_t camera) const {
  if (const CalibrationRun* const run = runInView())
    return {run_session_.boardOf(camera), run->detections.lenses.at(camera).detection_intrinsics};
  if (!session_ || camera >= session_->cameras.size()) return {};
  return {session_->boardOf(camera), session_->sensor(camera).intrinsics};
}

void DetectionScreen::showRun() {
  const BoardObservations* const seen = runInView() ? &run_->detections.cameras[camera_] : nullptr;
  const bool posed = seen && hasPoses(*run_);
  layer_boxes_[static_cast<std::size_t>(Layer::Reprojection)]->setEnabled(posed);
  timeline_->setWindows(seen ? seen->windows : std::vector<WindowReport>{});
  engine_->setObservations(seenBy(camera_));
  engine_->setResult(posed ? std::shared_ptr<const CalibrationState>(run_, &run_->result.state) : nullptr);
  engine_->setSight(detectionSetupOf(camera_));
  listWindows();
  showMarksAlone();
  offerPictures();
  request();
}

std::shared_ptr<CalibrationObserver> DetectionScreen::liveObserver() {
  return live_detection_->observer(options_);
}

void DetectionScreen::setLive(bool live) {
  if (live == live_) return;
  live_ = following_ = live;
  setPlaying(false);
  follow_button_->setVisible(live);
  follow_button_->setChecked(live);
  listWindows();
  if (live) {
    timeline_->setWindows({});
  } else {
    request();
  }
  refresh();
}

void DetectionScreen::showLiveFrame(std::shared_ptr<const LiveWindow> window) {
  if (!live_ || !window || framesInView()) return;
  if (following_ && second_camera_->isOf(window->camera)) return second_camera_->showLive(window, style());
  if (window->camera != camera_) return;
  if (window->windows) timeline_->setWindows(*window->windows);
  if (!following_) return;
  analysis_ = window->analysis;
  if (window->time_s) {
    time_s_ = *window->time_s;
    time_is_chosen_ = false;
    timeline_->setTime(time_s_);
  }
  engine_->showLive(std::move(window), style());
  refresh();
}

std::optional<KeptEvents> DetectionScreen::keptEvents() const {
  return engine_->keptEvents();
}

void DetectionScreen::setTime(double time_s) {
  if (following()) return;
  time_is_chosen_ = true;
  moveTo(time_s);
}

void DetectionScreen::moveTo(double time_s) {
  if (time_s == time_s_) return;
  time_s_ = time_s;
  timeline_->setTime(time_s);
  request();
  refresh();
}

void DetectionScreen::select(double time_s) {
  setTime(time_s);
  emit timeSelected(time_s_);
}

void DetectionScreen::setCamera(std::size_t camera) {
  camera_box_->setCurrentIndex(static_cast<int>(camera));
}

void DetectionScreen::setMode(SurfaceMode mode) {
  mode_box_->setCurrentIndex(static_cast<int>(mode));
}

void DetectionScreen::setLayerVisible(Layer layer, bool visible) {
  layer_boxes_[static_cast<std::size_t>(layer)]->setChecked(visible);
}

void DetectionScreen::setPlaying(bool playing) {
  if (playing == timer_.isActive()) return;
  if (playing && (!engine_->isOpen() || following())) return;
  if (playing) {
    if (time_s_ >= endOfPlay_s() - 1e-3) setTime(timeline_->begin_s());
    since_frame_.start();
    timer_.start(kFrame_ms);
  } else {
    timer_.stop();
    request();
  }
  play_button_->setIcon(icon(playing ? "pause" : "play"));
  play_button_->setToolTip(playing ? tr("Pause (Space)") : tr("Play (Space)"));
}

double DetectionScreen::endOfPlay_s() const {
  return timeline_->end_s();
}

void DetectionScreen::advance() {
  const double step_s =
      1e-9 * static_cast<double>(since_frame_.nsecsElapsed()) * speed_box_->currentData().toDouble();
  since_frame_.restart();
  select(std::min(time_s_ + step_s, endOfPlay_s()));
  if (time_s_ >= endOfPlay_s()) setPlaying(false);
}

void DetectionScreen::step(int direction) {
  setPlaying(false);
  following_ = false;
  follow_button_->setChecked(false);
  const auto frame_s = engine_->timeOfFrameBeside_s(time_s_, direction);
  if (framesInView() && !frame_s) return;
  select(framesInView() ? *frame_s : timeline_->stepFrom(time_s_, direction));
}

void DetectionScreen::request() {
  keepSecondOpen();
  if (following()) return;
  const bool playing = timer_.isActive();
  const DetectionOptions& detection = options_.detection;
  const auto window = timeline_->windowAt(time_s_);
  DetectionRequest wish;
  wish.time_s = time_s_;
  wish.half_width_s =
      window ? window->half_width_s : 0.25 * (detection.min_window_s + detection.max_window_s);
  wish.style = style();
  wish.picture = picture();
  wish.search = !playing || shown(Layer::Circles);
  wish.flow = !playing || shown(Layer::Flow) || shown(Layer::Clusters) || shown(Layer::Pairs);
  engine_->show(wish);
  showSecond(wish);
}

QString DetectionScreen::missingRecording() const {
  if (!session_ || camera_ >= session_->cameras.size()) return {};
  const std::filesystem::path& own = session_->cameras[camera_].recording;
  const std::filesystem::path& path = own.empty() ? session_->recording : own;
  return pathExists(path) ? QString() : QString::fromStdString(path.string());
}

void DetectionScreen::showMarksAlone() {
  const CalibrationRun* const run = runInView();
  if (run == nullptr || engine_->overview().error.empty() || engine_->overview().started) return;
  const std::vector<WindowReport>& windows = run->detections.cameras[camera_].windows;
  if (!windows.empty()) timeline_->setRange(0.0, windows.back().time_s);
}

void DetectionScreen::takeOverview() {
  const RecordingOverview overview = engine_->overview();
  const QString missing = overview.error.empty() ? QString() : missingRecording();
  look_for_->setVisible(!missing.isEmpty());
  showMarksAlone();
  if (!overview.error.empty()) {
    view_->setMessage(
        missing.isEmpty()
            ? tr("The recording cannot be read.\n%1").arg(QString::fromStdString(overview.error))
            : tr("The recording is missing:\n%1").arg(missing));
    status_->setText(missing.isEmpty() ? tr("not readable to the end") : tr("recording missing"));
    status_->setToolTip(QString::fromStdString(overview.error));
    if (!overview.started) return;
  } else {
    status_->setText(overview.finished ? QString()
                                       : tr("reading %1 %").arg(100.0 * overview.fraction_read, 0, 'f', 0));
    status_->setToolTip(tr("Recordings are read once, so that any time can be shown immediately"));
  }
  if (!overview.started) return;
  adaptTo(overview.kind);
  companion_ = overview.companion;
  const std::size_t cameras = session_->cameras.size();
  if (!companion_ && cameras > 1) second_ = (camera_ + 1) % cameras;
  offerPictures();
  timeline_->setRange(0.0, std::max(overview.read_until_s, timeline_->end_s()));
  timeline_->setEventRate(overview.event_rate);
  timeline_->setRotationRate(overview.rotation_rate);
  showPictures();
  keepCursorInside(overview);
  timeline_->setTime(time_s_);
  request();
}

// The initial cursor is at a fixed time, before the length of the recording is known.
void DetectionScreen::keepCursorInside(const RecordingOverview& overview) {
  if (!overview.finished || time_s_ <= timeline_->end_s()) return;
  moveTo(0.5 * timeline_->end_s());
  emit timeSelected(time_s_);
}

void DetectionScreen::takeFrame() {
  view_->setFrame(engine_->takeFrame());
  refresh();
}

void DetectionScreen::takeAnalysis() {
  const auto analysis = engine_->takeAnalysis();
  if (following()) return;
  analysis_ = analysis;
  refresh();
}

SurfaceStyle DetectionScreen::style() const {
  const Theme& colours = theme();
  return {static_cast<SurfaceMode>(mode_box_->currentIndex()), 1e-3 * fade_box_->value(), colours.panel.rgb(),
          colours.brighter.rgb(), colours.darker.rgb()};
}

void DetectionScreen::refresh() {
  const auto& frame = view_->frame();
  const bool here = analysisIsHere();
  // While following, the panel's text is updated at a readable rate, not at the rate of pictures.
  if (!following()) panel_timer_.stop();
  if (!panel_timer_.isActive()) {
    refreshPanel();
    if (following()) panel_timer_.start();
  }
  list_->setTime(time_s_);
  if (frame) view_->setCaption((following() ? tr("live  ") : QString()) + captionOf(*frame));
  if (frame) view_->setLegend(legendOf(*frame, following() ? SurfaceMode::Accumulated : style().mode));
  {
    const QSignalBlocker quiet(time_box_);
    time_box_->setMaximum(std::max(timeline_->end_s(), time_s_));
    time_box_->setValue(time_s_);
  }
  const auto reprojection = frame ? reprojectionInto(camera_, frame->time_s) : std::vector<QPolygonF>{};
  view_->setOverlay([analysis = here ? analysis_ : nullptr, layers = layers_, reprojection](QPainter& painter,
                                                                                            double scale) {
    paintLayers(painter, scale, layers, analysis.get(), reprojection);
  });
  refreshCompanion();
}

bool DetectionScreen::analysisIsHere() const {
  const auto& frame = view_->frame();
  return analysis_ && frame && std::abs(analysis_->time_s - frame->time_s) <= analysis_->half_width_s;
}

void DetectionScreen::refreshPanel() {
  const bool here = analysisIsHere();
  if (framesInView() && analysis_ && !here) return;  // the shown picture is of the previous frame
  const bool unsettled = here && (framesInView() ? !analysis_->frame->settled : analysis_->searches.empty());
  const bool searching = unsettled && !timer_.isActive() && !following();
  const double time_s = here && framesInView() ? analysis_->time_s : time_s_;
  panel_->show(here ? analysis_.get() : nullptr, timeline_->windowAt(time_s), searching);
}

void DetectionScreen::addKeys() {
  addPageKey(this, Qt::Key_Space, [this] { setPlaying(!isPlaying()); });
  addPageKey(this, Qt::Key_Left, [this] { step(-1); });
  addPageKey(this, Qt::Key_Right, [this] { step(+1); });
  addPageKey(this, Qt::Key_Home, [this] { select(timeline_->begin_s()); });
  addPageKey(this, Qt::Key_End, [this] { select(timeline_->end_s()); });
  addPageKey(this, Qt::Key_M, [this] { stepToMissed(+1); });
  addPageKey(this, Qt::SHIFT | Qt::Key_M, [this] { stepToMissed(-1); });
  addPageKey(this, Qt::Key_W, [this] { list_button_->click(); });
  addPageKey(this, Qt::Key_F, [this] {
    view_->fit();
    companion_view_->fit();
  });
  leaveFocusToKeys(this);
}

void DetectionScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) applyColours();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
