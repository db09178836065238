// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/inspection_job.h"

#include <utility>

namespace evical::ui {

InspectionJob::InspectionJob(QObject* parent) : QObject(parent) {
  connect(&runner_, &JobRunner::progressed, this,
          [this](const JobProgress& progress) { emit progressed(progress.fraction); });
  connect(&runner_, &JobRunner::failed, this,
          [this](const JobError& error) { emit failed(recording_, error); });
  connect(&runner_, &JobRunner::finished, this, &InspectionJob::finish);
}

void InspectionJob::start(const QString& recording) {
  next_ = recording;
  if (runner_.running()) {
    runner_.cancel();
  } else {
    run();
  }
}

void InspectionJob::run() {
  recording_ = std::exchange(next_, {});
  inspection_ = std::make_shared<Inspection>();
  emit started(recording_);
  runner_.start(tr("Inspect"), {{"inspect", 1.0}},
                [path = recording_.toStdString(), result = inspection_](const RunContext& context) {
                  context.progress.stageStarted("inspect");
                  const std::unique_ptr<RecordingReader> reader = openRecording(path);
                  *result = inspectRecording(*reader, {}, context);
                });
}

void InspectionJob::finish(JobOutcome outcome) {
  if (outcome == JobOutcome::Done && next_.isEmpty()) emit inspected(recording_, inspection_);
  if (!next_.isEmpty()) run();
}

}  // namespace evical::ui
