// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/inspection_job.h"

namespace evical::ui {

InspectionJob::InspectionJob(QObject* parent) : QObject(parent) {
  connect(&runner_, &JobRunner::progressed, this, [this](const JobProgress& progress) {
    if (!recording_.isEmpty()) emit progressed(progress.fraction);
  });
  connect(&runner_, &JobRunner::failed, this, [this](const JobError& error) {
    if (!recording_.isEmpty()) emit failed(recording_, error);
  });
  connect(&runner_, &JobRunner::finished, this, &InspectionJob::finish);
}

void InspectionJob::start(const QStringList& recordings) {
  waiting_ = recordings;
  recording_.clear();
  emit restarted();
  if (runner_.running()) {
    runner_.cancel();
  } else {
    next();
  }
}

void InspectionJob::add(const QString& recording) {
  waiting_ << recording;
  if (!runner_.running()) next();
}

void InspectionJob::next() {
  if (waiting_.isEmpty()) return;
  recording_ = waiting_.takeFirst();
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
  if (outcome == JobOutcome::Done && !recording_.isEmpty()) emit inspected(recording_, inspection_);
  next();
}

}  // namespace evical::ui
