// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/repeat_job.h"

#include "core/data/calibration_stage.h"
#include "core/pipeline/repeat/repeat_files.h"
#include "core/pipeline/rig/prefixed_progress.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace evical::ui {
namespace {

RunStart startOf(const Session& session) {
  const bool known =
      std::all_of(session.cameras.begin(), session.cameras.end(), [](const SessionCamera& camera) {
        return camera.intrinsics.has_value() || !camera.same_sensor_as.empty();
      });
  return known ? RunStart::KnownIntrinsics : RunStart::UnknownIntrinsics;
}

std::vector<JobStage> repeatStages(const RepeatInput& input) {
  constexpr double kComparing = 0.02;
  std::vector<JobStage> stages;
  for (std::size_t k = 0; k < input.sessions.size(); ++k)
    for (const StageRow& row : kCalibrationStages)
      if (const double share = shareOf(row, startOf(input.sessions[k])); share > 0.0)
        stages.push_back({QString::fromStdString(prefixedStage(partOfRepeat(input, k), row.name)), share});
  stages.push_back({kComparingStage, kComparing});
  return stages;
}

}  // namespace

RepeatJob::RepeatJob(JobRunner& runner, QObject* parent) : QObject(parent), runner_(runner) {
  connect(&runner_, &JobRunner::finished, this, &RepeatJob::finish);
}

bool RepeatJob::start(RepeatInput input, const QString& folder, const QString& version) {
  if (runner_.running()) return false;
  found_ = std::make_shared<RepeatedRecordings>();
  found_->input = std::move(input);
  found_->folder = folder;
  // The runner waits for its work, so that it is there as long as anybody asks for the log.
  const auto job = [&runner = std::as_const(runner_), version = version.toStdString(),
                    found = found_](const RunContext& context) {
    found->run = repeatInto(
        found->folder.toStdString(), found->input, version, [&] { return runner.logText().toStdString(); },
        context);
  };
  if (!runner_.start(tr("Several recordings"), repeatStages(found_->input), job)) {
    found_.reset();
    return false;
  }
  emit started();
  return true;
}

void RepeatJob::finish(JobOutcome outcome) {
  const std::shared_ptr<RepeatedRecordings> found = std::exchange(found_, nullptr);
  if (!found) return;
  emit ended();
  if (outcome == JobOutcome::Done) emit repeated(found);
}

}  // namespace evical::ui
