// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/task_job.h"

namespace evical::ui {

TaskJob::TaskJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  connect(&runner_, &JobRunner::finished, this, &TaskJob::finish);
}

bool TaskJob::startWork(const QString& title, std::vector<JobStage> stages, JobRunner::Work work,
                        std::function<void()> keep) {
  if (runner_.running()) return false;
  running_ = true;
  keep_ = std::move(keep);
  if (!runner_.start(title, std::move(stages), std::move(work))) running_ = false;
  return running_;
}

void TaskJob::finish(JobOutcome outcome) {
  if (!std::exchange(running_, false)) return;
  const auto keep = std::exchange(keep_, nullptr);
  if (outcome != JobOutcome::Done) return;
  log_ = runner_.logText();
  keep();
  emit done();
}

}  // namespace evical::ui
