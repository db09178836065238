// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration of one camera's lens as a job, which shows the front end's windows and the result of each pass.
#pragma once

#include "core/pipeline/lens/intrinsics_calibration.h"
#include "ui/jobs/calibration_job.h"
#include "ui/jobs/job_runner.h"

#include <QObject>

#include <memory>
#include <vector>

namespace evical::ui {

// Result of a run: the lens; and the views of the board, in the session's time, with an entry for each of its
// cameras, for screens that show runs.
struct FoundLens {
  std::shared_ptr<const IntrinsicsRun> run;
  std::shared_ptr<const CalibrationRun> seen;
};

class IntrinsicsJob : public QObject {
  Q_OBJECT

 public:
  explicit IntrinsicsJob(JobRunner& runner, QObject* parent = nullptr);

  // Like in CalibrationJob.
  void observeWith(CalibrationJob::ObserverMaker maker) { make_observer_ = std::move(maker); }

  // Works on a copy. False while the runner is busy.
  bool start(const Session& session, std::size_t camera);
  bool running() const { return live_ != nullptr; }

  // Names of stages: "first look", then "pass 1", "pass 2", ...
  static QString passName(int number) { return QString("pass %1").arg(number); }

 signals:
  void started();
  void ended();  // with any outcome
  void detectionsChanged(std::shared_ptr<const evical::ui::LiveDetections> detections);
  void passDone(const evical::ui::LensPass& pass);
  void calibrated(const evical::ui::FoundLens& found, const evical::Session& session, std::size_t camera,
                  const QString& log);

 private:
  void deliver();
  void finish(JobOutcome outcome);

  JobRunner& runner_;
  CalibrationJob::ObserverMaker make_observer_;
  std::shared_ptr<LiveView> live_;
  std::shared_ptr<FoundLens> found_;  // written by the work, read after its end
  Session session_;
  std::size_t camera_ = 0;
};

}  // namespace evical::ui
