// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/assessment_jobs.h"

#include "core/data/calibration_observer.h"
#include "core/pipeline/repeat/repeat_files.h"
#include "core/pipeline/rig/prefixed_progress.h"

#include <algorithm>
#include <string>

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

namespace evical::ui {
namespace {

// Stages of a calibration, each with the part `part`.
void addStages(RunStart start, const std::string& part, double weight, std::vector<JobStage>& stages) {
  for (const StageRow& row : kCalibrationStages)
    if (const double share = shareOf(row, start); share > 0.0)
      stages.push_back({{row.name, part}, weight * share});
}

// The lens is fixed by the old result; the second run starts from the detections of the first one.
std::vector<JobStage> resultCheckStages() {
  constexpr double kTogether = 0.4;  // share of the first run's time
  std::vector<JobStage> stages;
  addStages(RunStart::KnownIntrinsics, {}, 1.0, stages);
  addStages(RunStart::Detections, kTogetherPart, kTogether, stages);
  return stages;
}

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
    addStages(startOf(input.sessions[k]), partOfRepeat(input, k), 1.0, stages);
  stages.push_back({kComparingStage, kComparing});
  return stages;
}

}  // namespace

bool startResultCheck(ResultCheckJob& job, std::function<CheckInput()> read, const QString& version) {
  return job.start(QObject::tr("Check the result"), resultCheckStages(),
                   [read = std::move(read), version = version.toStdString()](CheckedResult& found,
                                                                             const RunContext& context) {
                     found.input = read();
                     found.run = checkCalibration(found.input, context);
                     found.run.check.version = version;
                   });
}

bool startMaintain(MaintainJob& job, std::function<MaintainInput()> read, const QString& version) {
  std::vector<JobStage> stages;
  for (const MaintainStage& stage : kMaintainStages) stages.push_back({stage.name, stage.share});
  return job.start(QObject::tr("IMUs over time"), std::move(stages),
                   [read = std::move(read), version = version.toStdString()](Maintenance& found,
                                                                             const RunContext& context) {
                     found = maintainImus(read(), context);
                     found.version = version;
                   });
}

bool startRepeat(RepeatJob& job, const RepeatInput& input, const QString& folder, const QString& version) {
  // The runner outlives its work, so it is valid when the log is requested.
  return job.start(QObject::tr("Several recordings"), repeatStages(input),
                   [&runner = job.runner(), input, folder, version = version.toStdString()](
                       RepeatedRecordings& found, const RunContext& context) {
                     found.input = input;
                     found.folder = folder;
                     found.run = repeatInto(
                         folder.toStdString(), input, version, [&] { return runner.logText().toStdString(); },
                         context);
                   });
}

}  // namespace evical::ui
