// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/maintain_job.h"

#include <utility>
#include <vector>

namespace evical::ui {

MaintainJob::MaintainJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  connect(&runner_, &JobRunner::finished, this, &MaintainJob::finish);
}

bool MaintainJob::start(std::function<MaintainInput()> read, const QString& version) {
  if (runner_.running()) return false;
  found_ = std::make_shared<MaintainedLogs>();
  const auto job = [read = std::move(read), version = version.toStdString(),
                    found = found_](const RunContext& context) {
    found->maintenance = maintainImus(read(), context);
    found->maintenance.version = version;
  };
  std::vector<JobStage> stages;
  for (const MaintainStage& stage : kMaintainStages) stages.push_back({stage.name, stage.share});
  if (!runner_.start(tr("IMUs over time"), std::move(stages), job)) {
    found_.reset();
    return false;
  }
  emit started();
  return true;
}

void MaintainJob::finish(JobOutcome outcome) {
  const std::shared_ptr<MaintainedLogs> found = std::exchange(found_, nullptr);
  if (!found) return;
  emit ended();
  if (outcome != JobOutcome::Done) return;
  found->log = runner_.logText();
  emit maintained(found);
}

}  // namespace evical::ui
