// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/result_check_job.h"

#include "core/data/calibration_stage.h"
#include "core/pipeline/rig/prefixed_progress.h"

#include <utility>
#include <vector>

namespace evical::ui {
namespace {

// The lens is given by the old result; the second run starts from what the first one detected.
std::vector<JobStage> resultCheckStages() {
  constexpr double kTogether = 0.4;  // of the first run's time
  std::vector<JobStage> stages;
  for (const StageRow& row : kCalibrationStages)
    if (const double share = shareOf(row, RunStart::KnownIntrinsics); share > 0.0)
      stages.push_back({row.name, share});
  for (const StageRow& row : kCalibrationStages)
    if (const double share = shareOf(row, RunStart::Detections); share > 0.0)
      stages.push_back({QString::fromStdString(prefixedStage(kTogetherPart, row.name)), kTogether * share});
  return stages;
}

}  // namespace

ResultCheckJob::ResultCheckJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  connect(&runner_, &JobRunner::finished, this, &ResultCheckJob::finish);
}

bool ResultCheckJob::start(std::function<CheckInput()> read, const QString& version) {
  if (runner_.running()) return false;
  found_ = std::make_shared<CheckedResult>();
  const auto job = [read = std::move(read), version = version.toStdString(),
                    found = found_](const RunContext& context) {
    found->input = read();
    found->run = checkCalibration(found->input, context);
    found->run.check.version = version;
  };
  if (!runner_.start(tr("Check the result"), resultCheckStages(), job)) {
    found_.reset();
    return false;
  }
  emit started();
  return true;
}

void ResultCheckJob::finish(JobOutcome outcome) {
  const std::shared_ptr<CheckedResult> found = std::exchange(found_, nullptr);
  if (!found) return;
  emit ended();
  if (outcome != JobOutcome::Done) return;
  found->log = runner_.logText();
  emit checked(found);
}

}  // namespace evical::ui
