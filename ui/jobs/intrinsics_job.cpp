// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/intrinsics_job.h"

#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/pipeline/pass/session_recording.h"
#include "ui/jobs/mailbox.h"

#include <utility>

namespace evical::ui {
namespace {

// Of an everyday recording's time. Nobody knows how many passes there will be: most lenses settle in one or two.
std::vector<JobStage> lensStages(int most_passes) {
  constexpr double kFirstLook = 0.1, kFirstPass = 0.7, kNext = 0.3;
  std::vector<JobStage> stages = {{nameOf(CalibrationStage::FirstLook), kFirstLook}};
  double share = kFirstPass;
  for (int pass = 1; pass <= most_passes; ++pass, share *= kNext)
    stages.push_back({IntrinsicsJob::passName(pass), share});
  return stages;
}

// Core names every pass alike.
class PassNames final : public ProgressSink {
 public:
  explicit PassNames(ProgressSink& sink) : sink_(sink) {}

  void stageStarted(std::string_view stage) override {
    if (stage != nameOf(CalibrationStage::Intrinsics)) return sink_.stageStarted(stage);
    sink_.stageStarted(IntrinsicsJob::passName(++passes_).toStdString());
  }
  void stageProgress(double fraction_of_stage) override { sink_.stageProgress(fraction_of_stage); }
  void log(LogLevel level, std::string_view text) override { sink_.log(level, text); }

 private:
  ProgressSink& sink_;
  int passes_ = 0;
};

// The camera was seen alone, in time from its own start.
RecordingPass inSession(const Session& session, std::size_t camera, const RecordingPass& alone) {
  RecordingPass all;
  all.start_ns = session.cameras.size() == 1 && session.imus.empty() ? alone.start_ns
                                                                     : SessionRecording(session).start_ns();
  all.cameras.resize(session.cameras.size());
  all.lenses.resize(session.cameras.size());
  all.resolutions_px.resize(session.cameras.size());
  for (std::size_t k = 0; k < session.cameras.size(); ++k) all.cameras[k].camera = session.cameras[k].name;
  BoardObservations& seen = all.cameras[camera] = alone.cameras.front();
  all.lenses[camera] = alone.lenses.front();
  all.resolutions_px[camera] = alone.resolutions_px.front();
  const double later_s = secondsSince(all.start_ns, alone.start_ns);
  for (WindowReport& window : seen.windows) window.time_s += later_s;
  for (BoardView& view : seen.views) {
    view.time_s += later_s;
    for (CircleObservation& circle : view.circles) circle.time_s += later_s;
  }
  return all;
}

FoundLens find(const Session& session, std::size_t camera, const RunContext& context) {
  const auto run = std::make_shared<IntrinsicsRun>(calibrateIntrinsics(session, camera, context));
  for (const RecordingFault& fault : run->pass.faults) context.progress.log(LogLevel::Warning, fault.text);
  const auto seen = std::make_shared<CalibrationRun>();
  seen->pass = inSession(session, camera, run->pass);
  return {run, seen};
}

}  // namespace

// Between core's threads and the GUI. Core watches a camera 0, which is the session's `camera`.
class IntrinsicsJob::LiveView final : public CalibrationObserver {
 public:
  LiveView(std::size_t cameras, std::size_t camera, std::shared_ptr<CalibrationObserver> windows)
      : camera_(camera), windows_(std::move(windows)), copies_(cameras) {}

  FrontEndObserver* windowObserver(std::size_t, const BoardTracker& tracker) override {
    return windows_ ? windows_->windowObserver(camera_, tracker) : nullptr;
  }
  void windowsDetected(std::size_t, const BoardObservations& so_far) override {
    copies_.take(camera_, so_far, detections);
  }
  void intrinsicsPassDone(int pass, const IntrinsicsResult& so_far) override {
    passes_.push_back({pass, so_far.views_found, so_far.reprojection_rms_px, so_far.moved_px});
    passes.put(std::make_shared<std::vector<LensPass>>(passes_));
  }

  Mailbox<LiveDetections> detections;
  Mailbox<std::vector<LensPass>> passes;  // all so far
  std::size_t said_passes = 0;            // the GUI thread's
  FoundLens found;                        // written by the work, read once it has ended

 private:
  std::size_t camera_;
  std::shared_ptr<CalibrationObserver> windows_;
  DetectionCopies copies_;
  std::vector<LensPass> passes_;
};

IntrinsicsJob::IntrinsicsJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  connect(&runner_, &JobRunner::ticked, this, &IntrinsicsJob::deliver);
  connect(&runner_, &JobRunner::finished, this, &IntrinsicsJob::finish);
}

bool IntrinsicsJob::start(const Session& session, std::size_t camera) {
  if (runner_.running() || camera >= session.cameras.size()) return false;
  session_ = session;
  camera_ = camera;
  live_ =
      std::make_shared<LiveView>(session.cameras.size(), camera, make_observer_ ? make_observer_() : nullptr);
  const auto job = [session, camera, live = live_](const RunContext& context) {
    PassNames names(context.progress);
    live->found = find(session, camera, RunContext{names, context.stop, live.get()});
  };
  if (!runner_.start(tr("Calibrate the camera"), lensStages(session.options.intrinsics->most_passes), job)) {
    live_.reset();
    return false;
  }
  emit started();
  return true;
}

void IntrinsicsJob::deliver() {
  if (!live_) return;
  const std::shared_ptr<LiveView> live = live_;
  const auto passes = live->passes.takeNew();
  const auto detections = live->detections.takeNew();
  if (detections) emit detectionsChanged(detections);
  for (; passes && live->said_passes < passes->size(); ++live->said_passes)
    emit passDone((*passes)[live->said_passes]);
}

void IntrinsicsJob::finish(JobOutcome outcome) {
  const std::shared_ptr<LiveView> live = std::exchange(live_, nullptr);
  if (!live) return;
  emit ended();
  if (outcome == JobOutcome::Done) emit calibrated(live->found, session_, camera_, runner_.logText());
}

}  // namespace evical::ui
