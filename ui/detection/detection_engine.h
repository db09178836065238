// SPDX-License-Identifier: GPL-3.0-or-later
// Background work of the detection screen, in three threads: one reads the recording, one draws the surface
// or the frame at the cursor, one runs the front end on the window there. Only the newest request of each
// kind is processed.
#pragma once

#include "ui/detection/event_cache.h"
#include "ui/detection/event_window_reader.h"
#include "ui/detection/events_over_frame.h"
#include "ui/detection/frame_analysis.h"
#include "ui/detection/live_detection.h"
#include "ui/detection/surface_frame.h"
#include "ui/detection/window_analysis.h"
#include "ui/detection/window_pictures.h"

#include "core/frontend/burst_window.h"
#include "core/frontend/edge_crossings.h"
#include "core/pipeline/session/session.h"
#include "ui/jobs/latest_job.h"
#include "ui/jobs/live_view.h"

#include <QObject>

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {

// For a camera with a companion of the other kind.
enum class PictureChoice { Alone, SideBySide, Overlaid };

struct DetectionRequest {
  double time_s = 0.0, half_width_s = 0.01;
  SurfaceStyle style;
  PictureChoice picture = PictureChoice::Alone;  // Overlaid: for frames, with a calibration
  bool search = true;                            // also search without a prediction
  bool flow = true;                              // also compute normal flow
};

// Board to search for, and the lens.
struct DetectionSetup {
  Board board;
  std::optional<CameraIntrinsics> lens = {};

  bool operator==(const DetectionSetup&) const = default;
};

// Events that can be read from any thread.
struct KeptEvents {
  std::size_t camera = 0;
  std::int64_t start_ns = 0;
  std::shared_ptr<const EventCache> cache;

  std::vector<Event> between(double begin_s, double end_s) const;
};

class DetectionEngine : public QObject {
  Q_OBJECT

 public:
  explicit DetectionEngine(QObject* parent = nullptr);
  ~DetectionEngine() override;

  void open(const Session& session, std::size_t camera);
  void setSight(const DetectionSetup& sight) { sight_ = sight; }
  void setOptions(const FrontEndOptions& options, const FrameOptions& frames) {
    options_ = options;
    frame_options_ = frames;
  }
  // Calibration for the open recording; null: none.
  void setResult(std::shared_ptr<const CalibrationState> result) { result_ = std::move(result); }
  void setObservations(std::shared_ptr<const BoardObservations> observations);
  void show(const DetectionRequest& wish);  // ignored before the recording is open
  void showLive(std::shared_ptr<const LiveWindow> window, const SurfaceStyle& style);

  bool isOpen() const { return reader_ != nullptr; }
  RecordingOverview overview() const;
  PictureSource pictureSource() const;  // of the part that has been read
  // Events of the shown camera or its companion; none if neither has events.
  std::optional<KeptEvents> keptEvents() const;
  // Time of the frame after the nearest (+1) or before it (-1); none if it does not exist.
  std::optional<double> timeOfFrameBeside_s(double time_s, int direction) const;
  std::shared_ptr<const SurfaceFrame> takeFrame() { return frames_.take(); }
  std::shared_ptr<const SurfaceFrame> takeCompanion() { return companions_.take(); }
  std::shared_ptr<const WindowAnalysis> takeAnalysis() { return analyses_.take(); }

 signals:
  void overviewChanged();
  void frameReady();
  void companionReady();
  void analysisReady();

 private:
  // Source of a camera's windows.
  struct Source {
    CameraKind kind = CameraKind::Events;
    std::shared_ptr<const EventCache> cache;
    std::shared_ptr<const FrameCache> frames;
    std::int64_t start_ns = 0;
    Resolution resolution_px;
    int opening = 0;
    Resolution events_px = {};
    std::size_t camera = 0, companion = 0;
    std::shared_ptr<const CalibrationState> result = nullptr;
  };
  struct RenderTask {
    Source source;
    DetectionRequest wish;
    std::shared_ptr<const LiveWindow> live;  // instead of the cache
  };
  struct AnalysisTask {
    Source source;
    DetectionSetup sight;
    DetectionRequest wish;
    FrontEndOptions options;
    FrameOptions frame_options;
    std::string camera;
    std::shared_ptr<const BoardObservations> observations;
  };
  class Analyst;

  void start(RenderTask task);
  void start(AnalysisTask task);
  void render(const RenderTask& task);
  void renderSurface(const RenderTask& task);
  void renderCompanion(const RenderTask& task);
  SurfaceFrame pictureAt(const Source& source, std::int64_t time_ns, const SurfaceStyle& style);
  void addEvents(const RenderTask& task, SurfaceFrame& frame);
  void put(SurfaceFrame frame, int opening);
  void put(const WindowAnalysis& analysis, int opening);

  DetectionSetup sight_;
  FrontEndOptions options_;
  FrameOptions frame_options_;
  std::string camera_name_;
  std::size_t camera_ = 0;
  std::shared_ptr<const CalibrationState> result_;
  std::shared_ptr<const BoardObservations> observations_;
  std::atomic<int> opening_ = 0;  // counts openings: results of earlier ones are dropped
  Mailbox<SurfaceFrame> frames_, companions_;
  Mailbox<WindowAnalysis> analyses_;
  std::shared_ptr<EventWindowReader> reader_;
  std::unique_ptr<Analyst> analyst_;
  // Used by the renderer only.
  DecayingSurface surface_;
  DecayingSurface companion_surface_;
  Resolution frame_px_;  // of the last decoded frame
  std::unique_ptr<EventsOverFrame> events_over_frame_;
  // Last members: their threads use the others.
  LatestJob read_job_{OutdatedWork::Dropped};
  LatestJob render_job_{OutdatedWork::Delivered};
  LatestJob analysis_job_{OutdatedWork::Delivered};
};

// Edge bursts around the cursor, from cached events. Up to ten seconds are kept, so that stepping and playing
// only add new ones. A jump costs one front-end history of events: 0.7 s.
class BurstBand {
 public:
  BurstBand(std::shared_ptr<const EventCache> cache, Resolution resolution_px, const BurstOptions& options);

  // Provides at least all bursts with begin_ns <= time < end_ns. False: the recording is not yet read that
  // far, and history() has only the existing ones.
  bool cover(std::int64_t begin_ns, std::int64_t end_ns);
  const BurstHistory& history() const { return history_; }

 private:
  void restart(std::int64_t begin_ns);
  void feedUntil(std::int64_t end_ns);

  std::shared_ptr<const EventCache> cache_;
  Resolution resolution_px_;
  BurstOptions options_;
  std::int64_t lead_ns_, lag_ns_;            // time before and after a burst in which events affect it
  std::optional<BurstExtractor> extractor_;  // null once finished
  BurstHistory history_;
  std::int64_t covered_from_ns_ = 0, fed_until_ns_ = 0;
  bool running_ = false;
  std::vector<Event> events_;
  std::vector<EdgeCrossing> bursts_;
};

}  // namespace evical::ui
