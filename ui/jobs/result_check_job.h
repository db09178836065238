// SPDX-License-Identifier: GPL-3.0-or-later
// Whether an old calibration still holds, as a job: what `evical check` does.
#pragma once

#include "core/pipeline/check/check_calibration.h"
#include "ui/jobs/job_runner.h"

#include <QObject>

#include <functional>
#include <memory>

namespace evical::ui {

// With what its files are written from.
struct CheckedResult {
  CheckInput input;
  CheckRun run;
  QString log;
};

class ResultCheckJob : public QObject {
  Q_OBJECT

 public:
  explicit ResultCheckJob(JobRunner& runner, QObject* parent = nullptr);

  // `read` is called in the job's thread. False while the runner is busy.
  bool start(std::function<CheckInput()> read, const QString& version);
  bool running() const { return found_ != nullptr; }

 signals:
  void started();
  void ended();  // in whatever way
  void checked(std::shared_ptr<const evical::ui::CheckedResult> result);

 private:
  void finish(JobOutcome outcome);

  JobRunner& runner_;
  std::shared_ptr<CheckedResult> found_;  // written by the work, read once it has ended
};

}  // namespace evical::ui
