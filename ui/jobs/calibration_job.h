// SPDX-License-Identifier: GPL-3.0-or-later
// A calibration as a job: what the front end and the optimiser find is shown while they run.
#pragma once

#include "core/pipeline/calibration_pipeline.h"
#include "ui/jobs/job_runner.h"

#include <functional>
#include <memory>
#include <vector>

namespace evical::ui {

// One entry a camera: its windows and views so far.
using LiveDetections = std::vector<BoardObservations>;

struct LiveIterations {
  std::vector<IterationRecord> records;  // all so far
  CalibrationState state;                // after the last of them
};

struct InitialisationNote {
  QString step, result;
  double duration_s = 0.0;
};

class CalibrationJob : public QObject {
  Q_OBJECT

 public:
  explicit CalibrationJob(JobRunner& runner, QObject* parent = nullptr);

  // Asked at each start for somebody who sees the front end's windows (recording_pass.h); may be empty.
  void observeWith(std::function<ObserverFactory()> observers) { observers_ = std::move(observers); }

  // Works on a copy. False while the runner is busy.
  bool start(const Session& session);
  // From detections that are there already.
  bool startAgain(const Session& session, RecordingPass pass,
                  std::vector<std::optional<IntrinsicsResult>> intrinsics = {});
  bool running() const { return live_ != nullptr; }

 signals:
  void started();
  void detecting();  // started, from the recording
  void ended();      // in whatever way
  // While it runs; only the newest of each kind is handed out, a few times a second.
  void detectionsChanged(std::shared_ptr<const evical::ui::LiveDetections> detections);
  void detectionDone(std::shared_ptr<const evical::CalibrationInput> input);
  void initialisationStepDone(const evical::ui::InitialisationNote& note);
  void iterationsChanged(std::shared_ptr<const evical::ui::LiveIterations> iterations);

  void calibrated(std::shared_ptr<const evical::CalibrationRun> run, const evical::Session& session,
                  const QString& log);

 private:
  class LiveView;

  using Work = std::function<CalibrationRun(const RunContext& context, CalibrationObserver* observer)>;
  bool run(const Session& session, const std::vector<JobStage>& stages, Work work);
  void deliver();
  void finish(JobOutcome outcome);

  JobRunner& runner_;
  std::function<ObserverFactory()> observers_;
  std::shared_ptr<LiveView> live_;
  Session session_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(evical::ui::InitialisationNote)
Q_DECLARE_METATYPE(std::shared_ptr<const evical::ui::LiveDetections>)
Q_DECLARE_METATYPE(std::shared_ptr<const evical::ui::LiveIterations>)
Q_DECLARE_METATYPE(std::shared_ptr<const evical::CalibrationInput>)
Q_DECLARE_METATYPE(std::shared_ptr<const evical::CalibrationRun>)
