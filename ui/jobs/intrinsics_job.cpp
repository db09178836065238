// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/intrinsics_job.h"

#include "core/base/time.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/pipeline/detection/session_recording.h"

#include <utility>

namespace evical::ui {
namespace {

// Shares of the time for a typical recording. The number of passes is unknown: most lenses settle in one or
// two.
std::vector<JobStage> lensStages(int max_passes) {
  constexpr double kFirstLook = 0.1, kFirstPass = 0.7, kNext = 0.3;
  std::vector<JobStage> stages = {{nameOf(CalibrationStage::FirstLook), kFirstLook}};
  double share = kFirstPass;
  for (int pass = 1; pass <= max_passes; ++pass, share *= kNext)
    stages.push_back({IntrinsicsJob::passName(pass).toStdString(), share});
  return stages;
}

// In core, all passes have the same name.
class PassNames final : public ProgressSink {
 public:
  explicit PassNames(ProgressSink& sink) : sink_(sink) {}

  void stageStarted(const ProgressStage& stage) override {
    if (stage.name != nameOf(CalibrationStage::Intrinsics)) return sink_.stageStarted(stage);
    sink_.stageStarted(IntrinsicsJob::passName(++passes_).toStdString());
  }
  void stageProgress(double fraction_of_stage) override { sink_.stageProgress(fraction_of_stage); }
  void log(LogLevel level, std::string_view text) override { sink_.log(level, text); }

 private:
  ProgressSink& sink_;
  int passes_ = 0;
};

// The camera was detected alone, in time since its own start.
DetectionResult inSession(const Session& session, std::size_t camera, const DetectionResult& alone) {
  DetectionResult all;
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
  for (const RecordingFault& fault : run->detections.faults)
    context.progress.log(LogLevel::Warning, fault.text);
  const auto seen = std::make_shared<CalibrationRun>();
  seen->detections = inSession(session, camera, run->detections);
  return {run, seen};
}

}  // namespace

IntrinsicsJob::IntrinsicsJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  connect(&runner_, &JobRunner::ticked, this, &IntrinsicsJob::deliver);
  connect(&runner_, &JobRunner::finished, this, &IntrinsicsJob::finish);
}

bool IntrinsicsJob::start(const Session& session, std::size_t camera) {
  if (runner_.running() || camera >= session.cameras.size()) return false;
  session_ = session;
  camera_ = camera;
  live_ =
      std::make_shared<LiveView>(session.cameras.size(), make_observer_ ? make_observer_() : nullptr, camera);
  found_ = std::make_shared<FoundLens>();
  const auto job = [session, camera, live = live_, found = found_](const RunContext& context) {
    PassNames names(context.progress);
    *found = find(session, camera, RunContext{names, context.stop, live.get()});
  };
  if (!runner_.start(tr("Calibrate the camera"), lensStages(session.options.intrinsics->max_passes), job)) {
    live_.reset();
    found_.reset();
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
  if (!std::exchange(live_, nullptr)) return;
  const std::shared_ptr<const FoundLens> found = std::exchange(found_, nullptr);
  emit ended();
  if (outcome == JobOutcome::Done) emit calibrated(*found, session_, camera_, runner_.logText());
}

}  // namespace evical::ui
