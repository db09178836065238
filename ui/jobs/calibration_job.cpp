// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/calibration_job.h"

#include <algorithm>
#include <utility>

namespace evical::ui {
namespace {

std::vector<JobStage> jobStages(RunStart start) {
  std::vector<JobStage> stages;
  for (const StageRow& row : kCalibrationStages)
    if (shareOf(row, start) > 0.0) stages.push_back({row.name, shareOf(row, start)});
  return stages;
}

}  // namespace

CalibrationJob::CalibrationJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  qRegisterMetaType<InitialisationNote>();
  connect(&runner_, &JobRunner::ticked, this, &CalibrationJob::deliver);
  connect(&runner_, &JobRunner::finished, this, &CalibrationJob::finish);
}

bool CalibrationJob::start(const Session& session) {
  const auto windows = make_observer_ && !runner_.running() ? make_observer_() : nullptr;
  const std::vector<CameraLens> lenses = givenLenses(session);
  const bool all_known = std::all_of(lenses.begin(), lenses.end(),
                                     [](const CameraLens& lens) { return lens.given.has_value(); });
  const RunStart from = all_known ? RunStart::KnownIntrinsics : RunStart::UnknownIntrinsics;
  const bool begun = run(session, from, windows,
                         [session](const RunContext& context) { return calibrate(session, context); });
  if (begun) emit detecting();
  return begun;
}

bool CalibrationJob::startAgain(const Session& session, DetectionResult detections,
                                std::vector<std::optional<IntrinsicsResult>> intrinsics) {
  const auto shared = std::make_shared<DetectionResult>(std::move(detections));
  return run(session, RunStart::Detections, nullptr,
             [session, shared, intrinsics = std::move(intrinsics)](const RunContext& context) {
               return calibrate(session, std::move(*shared), context, intrinsics);
             });
}

bool CalibrationJob::run(const Session& session, RunStart start, std::shared_ptr<CalibrationObserver> windows,
                         Work work) {
  if (runner_.running()) return false;
  session_ = session;
  started_from_ = start;
  live_ = std::make_shared<LiveView>(session.cameras.size(), std::move(windows));
  run_ = std::make_shared<CalibrationRun>();
  const auto job = [work = std::move(work), live = live_, made = run_](const RunContext& context) {
    *made = work(RunContext{context.progress, context.stop, live.get()});
  };
  if (!runner_.start(tr("Calibrate"), jobStages(start), job)) return false;
  emit started();
  return true;
}

void CalibrationJob::deliver() {
  if (!live_) return;
  const std::shared_ptr<LiveView> live = live_;
  // Taken in reverse order, so that everything earlier has arrived; delivered in order.
  const auto iterations = live->iterations.takeNew();
  const auto notes = live->notes.takeNew();
  const bool done = live->detection_done;
  const auto detections = live->detections.takeNew();
  if (detections) emit detectionsChanged(detections);
  if (done && !std::exchange(live->said_done, true)) emit detectionDone();
  for (; notes && live->said_notes < notes->size(); ++live->said_notes)
    emit initialisationStepDone((*notes)[live->said_notes]);
  if (iterations) emit iterationsChanged(iterations);
}

void CalibrationJob::finish(JobOutcome outcome) {
  const std::shared_ptr<LiveView> live = std::exchange(live_, nullptr);
  const std::shared_ptr<const CalibrationRun> run = std::exchange(run_, nullptr);
  if (live) emit ended();
  if (!live || outcome != JobOutcome::Done) return;
  emit calibrated(run, session_, runner_.logText());
}

}  // namespace evical::ui
