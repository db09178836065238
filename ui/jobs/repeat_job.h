// SPDX-License-Identifier: GPL-3.0-or-later
// Several recordings of one rig, alone and together, as a job: what `evical repeat` does.
#pragma once

#include "core/pipeline/repeat/repeat_calibration.h"
#include "ui/jobs/job_runner.h"

#include <QObject>

#include <memory>

namespace evical::ui {

struct RepeatedRecordings {
  RepeatInput input;
  RepeatRun run;
  QString folder;  // where its files are
};

class RepeatJob : public QObject {
  Q_OBJECT

 public:
  explicit RepeatJob(JobRunner& runner, QObject* parent = nullptr);

  // False while the runner is busy.
  bool start(RepeatInput input, const QString& folder, const QString& version);
  bool running() const { return found_ != nullptr; }

 signals:
  void started();
  void ended();  // in whatever way
  void repeated(std::shared_ptr<const evical::ui::RepeatedRecordings> recordings);

 private:
  void finish(JobOutcome outcome);

  JobRunner& runner_;
  std::shared_ptr<RepeatedRecordings> found_;  // written by the work, read once it has ended
};

}  // namespace evical::ui
