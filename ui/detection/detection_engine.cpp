// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/detection_engine.h"

#include "ui/detection/trajectory_pose.h"

#include "core/base/error.h"
#include "core/base/in_parallel.h"
#include "core/base/time.h"

#include <QStandardPaths>

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

namespace evical::ui {
namespace {

std::filesystem::path cacheFolder() {
  const QString folder = QStandardPaths::writableLocation(QStandardPaths::CacheLocation);
  return (folder.isEmpty() ? QStandardPaths::writableLocation(QStandardPaths::TempLocation) : folder)
      .toStdString();
}

std::size_t eventsOfWindow(const EventCache& cache, std::int64_t start_ns, const DetectionRequest& wish) {
  return cache.count(start_ns + nanosecondsFrom(wish.time_s - wish.half_width_s),
                     start_ns + nanosecondsFrom(wish.time_s + wish.half_width_s));
}

void gather(const EventCache& cache, std::int64_t start_ns, double begin_s, double end_s,
            std::vector<Event>& events) {
  cache.gather(start_ns + nanosecondsFrom(begin_s), start_ns + nanosecondsFrom(end_s), events);
}

}  // namespace

// State of the analysing thread.
class DetectionEngine::Analyst {
 public:
  explicit Analyst(DetectionEngine& engine) : engine_(engine) {}

  void handle(const AnalysisTask& task) {
    if (task.source.kind == CameraKind::Frames) {
      handleFrame(task);
      return;
    }
    prepare(task);
    WindowQuestion question;
    question.start_ns = task.source.start_ns;
    question.time_s = task.wish.time_s;
    question.half_width_s = task.wish.half_width_s;
    question.flow = task.wish.flow || task.wish.style.mode == SurfaceMode::NormalFlow;
    question.scene = scene_;
    question.options = task.options;
    question.observations = task.observations;
    if (question.observations && question.observations->single_events) {
      question.options = forSingleEvents(question.options);
      question.scene = scene_for_single_events_;
    }
    const TimeSpan needed = neededBursts_s(question);
    const auto at_ns = [&](double time_s) { return question.start_ns + nanosecondsFrom(time_s); };
    band_->cover(at_ns(needed.begin_s), at_ns(needed.end_s));
    WindowAnalysis analysis = analyseTracking(band_->history(), question);
    if (task.wish.style.mode == SurfaceMode::NormalFlow) renderArcs(task, analysis);
    engine_.put(analysis, task.source.opening);
    if (!task.wish.search || engine_.analysis_job_.hasNewer()) return;
    addSearch(band_->history(), question, analysis);
    if (task.wish.style.mode == SurfaceMode::NormalFlow) renderArcs(task, analysis);
    engine_.put(analysis, task.source.opening);
  }

 private:
  // First with the frames just before; if that finds only part of the board, with tracking from further back,
  // as in a run. The result is kept: a frame lasts longer than the cursor stays at one place.
  void handleFrame(const AnalysisTask& task) {
    const Source& source = task.source;
    FrameQuestion question;
    question.frames = source.frames;
    question.start_ns = source.start_ns;
    question.frame = *source.frames->nearest(source.start_ns + nanosecondsFrom(task.wish.time_s));
    question.frames_read = source.frames->count();
    question.camera = task.camera;
    question.board = task.sight.board;
    question.options = task.frame_options;
    if (question == frame_question_) {
      engine_.put(frame_analysis_, source.opening);
      return;
    }
    WindowAnalysis analysis = analyseFrame(question);
    const auto longer = static_cast<std::size_t>(question.options.search_every_frames);
    const bool look_further = goesFurther(analysis) && longer > question.frames_before;
    analysis.frame->settled = !look_further;
    engine_.put(analysis, source.opening);
    if (look_further) {
      if (engine_.analysis_job_.hasNewer()) return;
      FrameQuestion again = question;
      again.frames_before = longer;
      analysis = analyseFrame(again);
      engine_.put(analysis, source.opening);
    }
    frame_question_ = std::move(question);
    frame_analysis_ = std::move(analysis);
  }

  void prepare(const AnalysisTask& task) {
    const Source& source = task.source;
    if (!scene_ || task.sight != sight_ || source.resolution_px != scene_->resolution_px) {
      sight_ = task.sight;
      scene_ = std::make_shared<BoardScene>(sight_.board, source.resolution_px, sight_.lens);
      BoardScene for_single_events = *scene_;
      for_single_events.single_events = true;
      scene_for_single_events_ = std::make_shared<BoardScene>(std::move(for_single_events));
    }
    const BurstOptions bursts = burstsFor(sight_.board, task.options.bursts);
    if (band_ && bursts == bursts_ && source.cache == cache_) return;
    bursts_ = bursts;
    cache_ = source.cache;
    band_.emplace(cache_, source.resolution_px, bursts_);
  }

  void renderArcs(const AnalysisTask& task, const WindowAnalysis& analysis) {
    std::vector<Event> events;
    gather(*task.source.cache, task.source.start_ns, analysis.time_s - analysis.flow.half_window_s,
           analysis.time_s + analysis.flow.half_window_s, events);
    SurfaceFrame frame =
        renderFlow(events, analysis.flow.arcs.flow, task.source.start_ns + nanosecondsFrom(analysis.time_s),
                   task.source.resolution_px, task.wish.style);
    frame.time_s = analysis.time_s;
    frame.window_events = eventsOfWindow(*task.source.cache, task.source.start_ns, task.wish);
    engine_.put(std::move(frame), task.source.opening);
  }

  DetectionEngine& engine_;
  DetectionSetup sight_;
  std::shared_ptr<const BoardScene> scene_, scene_for_single_events_;
  BurstOptions bursts_;
  std::shared_ptr<const EventCache> cache_;
  std::optional<BurstBand> band_;
  FrameQuestion frame_question_;
  WindowAnalysis frame_analysis_;
};

DetectionEngine::DetectionEngine(QObject* parent)
    : QObject(parent),
      frames_(
          [this] { QMetaObject::invokeMethod(this, &DetectionEngine::frameReady, Qt::QueuedConnection); }),
      companions_([this] {
        QMetaObject::invokeMethod(this, &DetectionEngine::companionReady, Qt::QueuedConnection);
      }),
      analyses_(
          [this] { QMetaObject::invokeMethod(this, &DetectionEngine::analysisReady, Qt::QueuedConnection); }),
      analyst_(std::make_unique<Analyst>(*this)) {}

DetectionEngine::~DetectionEngine() = default;

void DetectionEngine::open(const Session& session, std::size_t camera) {
  observations_.reset();
  camera_name_ = session.cameras[camera].name;
  camera_ = camera;
  result_.reset();
  companions_.clear();
  ++opening_;
  frames_.clear();
  analyses_.clear();
  reader_ = std::make_shared<EventWindowReader>(session, camera, cacheFolder(), [this] {
    QMetaObject::invokeMethod(this, &DetectionEngine::overviewChanged, Qt::QueuedConnection);
  });
  read_job_.start([reader = reader_](const std::stop_token& stop) -> std::function<void()> {
    makeThreadModest();
    reader->read(stop);
    return nullptr;
  });
}

void DetectionEngine::setObservations(std::shared_ptr<const BoardObservations> observations) {
  observations_ = std::move(observations);
}

RecordingOverview DetectionEngine::overview() const {
  return reader_ ? reader_->overview() : RecordingOverview{};
}

PictureSource DetectionEngine::pictureSource() const {
  if (!reader_) return {};
  const RecordingOverview overview = reader_->overview();
  const RecordingCaches caches = reader_->caches();
  if (!overview.started) return {};
  return {overview.kind, caches.events, caches.frames, overview.start_ns, overview.resolution_px};
}

void DetectionEngine::show(const DetectionRequest& wish) {
  if (!reader_) return;
  const RecordingOverview overview = reader_->overview();
  const RecordingCaches caches = reader_->caches();
  const Source source{overview.kind,
                      caches.events,
                      caches.frames,
                      overview.start_ns,
                      overview.resolution_px,
                      opening_,
                      caches.events_px,
                      camera_,
                      overview.companion.value_or(camera_),
                      result_};
  const bool frames = overview.kind == CameraKind::Frames;
  if (frames ? !caches.frames || caches.frames->count() == 0 : !caches.events) return;
  const bool flow = !frames && wish.style.mode == SurfaceMode::NormalFlow;  // drawn by the analysis
  if (!flow || wish.picture == PictureChoice::SideBySide) start(RenderTask{source, wish, nullptr});
  start(AnalysisTask{source, sight_, wish, options_, frame_options_, camera_name_, observations_});
}

std::vector<Event> KeptEvents::between(double begin_s, double end_s) const {
  std::vector<Event> events;
  gather(*cache, start_ns, begin_s, end_s, events);
  return events;
}

std::optional<KeptEvents> DetectionEngine::keptEvents() const {
  if (!reader_) return std::nullopt;
  const RecordingOverview overview = reader_->overview();
  const RecordingCaches caches = reader_->caches();
  if (!overview.started || !caches.events) return std::nullopt;
  const bool own = overview.kind == CameraKind::Events;
  return KeptEvents{own ? camera_ : overview.companion.value_or(camera_), overview.start_ns, caches.events};
}

std::optional<double> DetectionEngine::timeOfFrameBeside_s(double time_s, int direction) const {
  if (!reader_) return std::nullopt;
  const RecordingOverview overview = reader_->overview();
  const auto frames = reader_->caches().frames;
  if (overview.kind != CameraKind::Frames || !frames) return std::nullopt;
  const auto nearest = frames->nearest(overview.start_ns + nanosecondsFrom(time_s));
  if (!nearest || (direction < 0 && *nearest == 0) || (direction > 0 && *nearest + 1 == frames->count()))
    return std::nullopt;
  return secondsSince(overview.start_ns, frames->time_ns(direction > 0 ? *nearest + 1 : *nearest - 1));
}

void DetectionEngine::showLive(std::shared_ptr<const LiveWindow> window, const SurfaceStyle& style) {
  RenderTask task;
  task.source.opening = opening_;
  task.source.resolution_px = window->analysis->scene->resolution_px;
  task.wish.style = style;
  task.live = std::move(window);
  start(std::move(task));
}

void DetectionEngine::start(RenderTask task) {
  render_job_.start([this, task = std::move(task)](const std::stop_token&) -> std::function<void()> {
    render(task);
    return nullptr;
  });
}

void DetectionEngine::start(AnalysisTask task) {
  analysis_job_.start([this, task = std::move(task)](const std::stop_token&) -> std::function<void()> {
    makeThreadModest();  // pictures have priority
    try {
      analyst_->handle(task);
    } catch (const CalibrationError&) {
      // The cache is unreadable; the renderer's picture stays empty, and the reader has reported the reason.
    }
    return nullptr;
  });
}

SurfaceFrame DetectionEngine::pictureAt(const Source& source, std::int64_t time_ns,
                                        const SurfaceStyle& style) {
  const FrameCache& frames = *source.frames;
  const std::size_t at = *frames.nearest(time_ns);
  SurfaceFrame shown;
  shown.time_s = secondsSince(source.start_ns, frames.time_ns(at));
  shown.photograph = FrameLabel{at + 1, frames.count()};
  try {
    shown.image = pictureOf(decodeFrame(frames.frame(at), "frame"));
    frame_px_ = shown.resolution_px();
  } catch (const CalibrationError&) {
    // The analysis reports the reason; the size of the picture does not change.
    shown.image = emptyImage(frame_px_.known() ? frame_px_ : Resolution{640, 480}, style);
  }
  return shown;
}

void DetectionEngine::addEvents(const RenderTask& task, SurfaceFrame& frame) {
  const Source& source = task.source;
  if (!source.cache || !source.result ||
      !EventsOverFrame::isPossible(*source.result, source.companion, source.camera))
    return;
  if (!events_over_frame_ ||
      !events_over_frame_->isOf(source.result, source.companion, source.camera, source.events_px))
    events_over_frame_ =
        std::make_unique<EventsOverFrame>(source.result, source.companion, source.camera, source.events_px);
  const double until_s = events_over_frame_->eventTime_s(frame.time_s);
  std::vector<Event> events;
  gather(*source.cache, source.start_ns, until_s - fadedAfter_s(task.wish.style), until_s, events);
  frame.events = paintEventsOver(*events_over_frame_, events, source.start_ns, frame.time_s, task.wish.style,
                                 frame.image);
}

// At the same moment, if a result contains the time offset between the clocks.
void DetectionEngine::renderCompanion(const RenderTask& task) {
  const Source& source = task.source;
  const bool of_frames = source.kind == CameraKind::Events;
  if (of_frames ? !source.frames || source.frames->count() == 0 : !source.cache) return;
  double time_s = task.wish.time_s;
  if (source.result && std::max(source.camera, source.companion) < source.result->cameras.size())
    time_s = timeOnClockOf_s(source.result->cameras[source.companion], source.result->cameras[source.camera],
                             time_s);
  const std::int64_t time_ns = source.start_ns + nanosecondsFrom(time_s);
  SurfaceStyle style = task.wish.style;
  style.mode = SurfaceMode::Decayed;
  SurfaceFrame frame;
  try {
    frame = of_frames ? pictureAt(source, time_ns, style)
                      : companion_surface_.render(source.cache, time_ns, source.events_px, style);
  } catch (const CalibrationError&) {
    return;  // the cache is unreadable, which the main picture's reader reports
  }
  if (!of_frames) frame.time_s = time_s;
  if (source.opening == opening_) companions_.put(std::make_shared<SurfaceFrame>(std::move(frame)));
}

void DetectionEngine::render(const RenderTask& task) {
  RenderTask shown = task;
  if (!task.live && task.source.kind == CameraKind::Frames) {
    SurfaceFrame frame =
        pictureAt(task.source, task.source.start_ns + nanosecondsFrom(task.wish.time_s), task.wish.style);
    shown.wish.time_s = frame.time_s;
    if (task.wish.picture == PictureChoice::Overlaid) addEvents(task, frame);
    put(std::move(frame), task.source.opening);
  } else {
    if (task.live || task.wish.style.mode != SurfaceMode::NormalFlow) renderSurface(task);
  }
  if (!task.live && task.wish.picture == PictureChoice::SideBySide) renderCompanion(shown);
}

void DetectionEngine::renderSurface(const RenderTask& task) {
  SurfaceStyle style = task.wish.style;
  if (task.live) {
    style.mode = SurfaceMode::Accumulated;
    SurfaceFrame frame =
        renderEvents(task.live->bursts, task.live->middle_ns, task.source.resolution_px, style);
    frame.time_s = task.live->time_s.value_or(0.0);
    put(std::move(frame), task.source.opening);
    return;
  }
  const DetectionRequest& wish = task.wish;
  const std::int64_t time_ns = task.source.start_ns + nanosecondsFrom(wish.time_s);
  SurfaceFrame frame;
  try {
    if (style.mode == SurfaceMode::Decayed) {
      frame = surface_.render(task.source.cache, time_ns, task.source.resolution_px, style);
    } else {
      std::vector<Event> events;
      gather(*task.source.cache, task.source.start_ns, wish.time_s - wish.half_width_s,
             wish.time_s + wish.half_width_s, events);
      frame = renderEvents(events, time_ns, task.source.resolution_px, style);
    }
    frame.window_events = eventsOfWindow(*task.source.cache, task.source.start_ns, wish);
  } catch (const CalibrationError&) {
    // The file is gone: the reader's message is more informative than an old picture.
    frame = renderEvents({}, time_ns, task.source.resolution_px, style);
  }
  frame.time_s = wish.time_s;
  put(std::move(frame), task.source.opening);
}

void DetectionEngine::put(SurfaceFrame frame, int opening) {
  if (opening != opening_) return;
  frames_.put(std::make_shared<SurfaceFrame>(std::move(frame)));
}

void DetectionEngine::put(const WindowAnalysis& analysis, int opening) {
  if (opening != opening_) return;
  analyses_.put(std::make_shared<WindowAnalysis>(analysis));
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

constexpr std::int64_t kKept_ns = 10'000'000'000;
constexpr std::int64_t kBackwards_ns = 200'000'000;  // margin for steps back without a restart
constexpr std::int64_t kChunk_ns = 50'000'000;
constexpr std::int64_t kEverything = std::numeric_limits<std::int64_t>::max();

}  // namespace

BurstBand::BurstBand(std::shared_ptr<const EventCache> cache, Resolution resolution_px,
                     const BurstOptions& options)
    : cache_(std::move(cache)),
      resolution_px_(resolution_px),
      options_(options),
      lead_ns_(nanosecondsFrom(options.max_burst_s + options.max_gap_s)),
      lag_ns_(nanosecondsFrom(longestHandOut_s(options))) {}

void BurstBand::restart(std::int64_t begin_ns) {
  extractor_.emplace(resolution_px_, options_);
  history_ = BurstHistory();
  covered_from_ns_ = begin_ns - kBackwards_ns;
  fed_until_ns_ = covered_from_ns_ - lead_ns_;
  running_ = true;
}

void BurstBand::feedUntil(std::int64_t end_ns) {
  while (fed_until_ns_ < end_ns) {
    const std::int64_t next_ns = std::min(fed_until_ns_ + kChunk_ns, end_ns);
    events_.clear();
    bursts_.clear();
    cache_->gather(fed_until_ns_, next_ns, events_);
    extractor_->add(events_, bursts_);
    history_.add(bursts_);
    fed_until_ns_ = next_ns;
  }
}

bool BurstBand::cover(std::int64_t begin_ns, std::int64_t end_ns) {
  const std::int64_t complete_ns = cache_->completeUntil_ns();
  const bool finished = complete_ns == kEverything;
  const bool far_ahead = fed_until_ns_ < begin_ns - lead_ns_ - kBackwards_ns;
  if (!running_ || begin_ns < covered_from_ns_ || (extractor_ && far_ahead)) restart(begin_ns);
  if (!extractor_) return true;  // already at the end
  const std::int64_t wanted_ns = end_ns + lag_ns_;
  feedUntil(std::min(wanted_ns, complete_ns));
  if (finished && fed_until_ns_ > cache_->lastEvent_ns()) {
    bursts_.clear();
    extractor_->finish(bursts_);
    history_.add(bursts_);
    extractor_.reset();
  }
  if (covered_from_ns_ < fed_until_ns_ - kKept_ns) {
    covered_from_ns_ = fed_until_ns_ - kKept_ns;
    history_.dropBefore(covered_from_ns_);
  }
  return finished || complete_ns >= wanted_ns;
}

}  // namespace evical::ui
