// SPDX-License-Identifier: GPL-3.0-or-later
// Whether IMUs are still as they were calibrated, from their logs, as a job: what `evical maintain` does.
#pragma once

#include "core/data/maintenance.h"
#include "core/pipeline/maintain/maintain_imus.h"
#include "ui/jobs/job_runner.h"

#include <QObject>

#include <functional>
#include <memory>

namespace evical::ui {

struct MaintainedLogs {
  Maintenance maintenance;
  QString log;
};

class MaintainJob : public QObject {
  Q_OBJECT

 public:
  explicit MaintainJob(JobRunner& runner, QObject* parent = nullptr);

  // `read` is called in the job's thread. False while the runner is busy.
  bool start(std::function<MaintainInput()> read, const QString& version);
  bool running() const { return found_ != nullptr; }

 signals:
  void started();
  void ended();  // in whatever way
  void maintained(std::shared_ptr<const evical::ui::MaintainedLogs> result);

 private:
  void finish(JobOutcome outcome);

  JobRunner& runner_;
  std::shared_ptr<MaintainedLogs> found_;  // written by the work, read once it has ended
};

}  // namespace evical::ui
