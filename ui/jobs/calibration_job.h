// SPDX-License-Identifier: GPL-3.0-or-later
// A calibration as a job that shows intermediate results of the front end and the optimiser.
#pragma once

#include "core/data/calibration_observer.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "ui/jobs/job_runner.h"
#include "ui/jobs/live_view.h"

#include <functional>
#include <memory>
#include <vector>

namespace evical::ui {

class CalibrationJob : public QObject {
  Q_OBJECT

 public:
  explicit CalibrationJob(JobRunner& runner, QObject* parent = nullptr);

  // Called at each start from the recording, for an observer of the front end's windows; may be empty.
  using ObserverMaker = std::function<std::shared_ptr<CalibrationObserver>()>;
  void observeWith(ObserverMaker maker) { make_observer_ = std::move(maker); }

  // Works on a copy. False while the runner is busy.
  bool start(const Session& session);
  // Starts from existing detections.
  bool startAgain(const Session& session, DetectionResult detections,
                  std::vector<std::optional<IntrinsicsResult>> intrinsics = {});
  bool running() const { return live_ != nullptr; }
  // Start of the latest run.
  RunStart startedFrom() const { return started_from_; }

 signals:
  void started();
  void detecting();  // started, from the recording
  void ended();      // with any outcome
  // During a run; only the newest of each kind is emitted, a few times a second.
  void detectionsChanged(std::shared_ptr<const evical::ui::LiveDetections> detections);
  void detectionDone();
  void initialisationStepDone(const evical::ui::InitialisationNote& note);
  void iterationsChanged(std::shared_ptr<const evical::ui::LiveIterations> iterations);

  void calibrated(std::shared_ptr<const evical::CalibrationRun> run, const evical::Session& session,
                  const QString& log);

 private:
  using Work = std::function<CalibrationRun(const RunContext& context)>;
  bool run(const Session& session, RunStart start, std::shared_ptr<CalibrationObserver> windows, Work work);
  void deliver();
  void finish(JobOutcome outcome);

  JobRunner& runner_;
  ObserverMaker make_observer_;
  std::shared_ptr<LiveView> live_;
  std::shared_ptr<CalibrationRun> run_;  // written by the work, read after its end
  Session session_;
  RunStart started_from_ = RunStart::KnownIntrinsics;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(evical::ui::InitialisationNote)
Q_DECLARE_METATYPE(std::shared_ptr<const evical::ui::LiveDetections>)
Q_DECLARE_METATYPE(std::shared_ptr<const evical::ui::LiveIterations>)
Q_DECLARE_METATYPE(std::shared_ptr<const evical::CalibrationRun>)
