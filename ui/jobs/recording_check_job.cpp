// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/recording_check_job.h"

#include "core/base/in_parallel.h"
#include "core/data/calibration_observer.h"

#include <utility>

namespace evical::ui {
namespace {

constexpr int kPause_ms = 800;  // avoids checks between key strokes

// By core's names, with shares of the time for a typical recording.
std::vector<JobStage> checkStages() {
  return {{nameOf(CalibrationStage::FirstLook), 0.05},
          {nameOf(CalibrationStage::Intrinsics), 0.25},
          {nameOf(CalibrationStage::Detect), 0.5},
          {"assess", 0.2}};
}

}  // namespace

RecordingCheckJob::RecordingCheckJob(QObject* parent) : QObject(parent) {
  qRegisterMetaType<std::shared_ptr<const CheckedRecording>>();
  pause_.setSingleShot(true);
  pause_.setInterval(kPause_ms);
  connect(&pause_, &QTimer::timeout, this, &RecordingCheckJob::start);
  connect(&runner_, &JobRunner::progressed, this, [this](const JobProgress& progress) {
    if (!due_) emit progressed(progress.fraction);
  });
  connect(&runner_, &JobRunner::failed, this, [this](const JobError& error) {
    if (!due_) emit failed(error);
  });
  connect(&runner_, &JobRunner::finished, this, &RecordingCheckJob::finish);
}

void RecordingCheckJob::setAutomatic(bool automatic) {
  if (automatic == automatic_) return;
  automatic_ = automatic;
  if (!automatic) {
    pause_.stop();
    due_ = due_ || runner_.running();
    runner_.cancel();
    if (!checked_) emit outdated();  // nobody awaits it any more
    return;
  }
  due_ = due_ || checked_ == nullptr;
  startSoon();
}

void RecordingCheckJob::setSession(std::optional<Session> session) {
  const bool same =
      session.has_value() == session_.has_value() && (!session || sameExceptNames(*session, *session_));
  session_ = std::move(session);
  if (same) return;
  asked_ = false;
  if (!session_) detected_.reset();
  checked_.reset();
  due_ = session_.has_value();
  runner_.cancel();
  emit outdated();
  startSoon();
}

void RecordingCheckJob::lookAgain() {
  if (!session_ || runner_.running()) return;
  asked_ = true;
  due_ = true;
  detected_.reset();
  start();
}

void RecordingCheckJob::giveWay(bool busy) {
  if (busy == busy_) return;
  busy_ = busy;
  if (!busy) return startSoon();
  pause_.stop();
  if (!runner_.running()) return;
  due_ = session_.has_value();
  runner_.cancel();
  emit interrupted();
}

void RecordingCheckJob::startSoon() {
  if (due_ && mayStart() && !busy_) pause_.start();
}

void RecordingCheckJob::start() {
  if (!due_ || busy_ || !mayStart() || !session_ || runner_.running()) return;
  due_ = false;
  found_ = std::make_shared<CheckedRecording>();
  found_for_ = *session_;
  const auto kept = detected_ && detectsTheSame(detected_for_, found_for_) ? detected_ : nullptr;
  const auto work = [session = found_for_, found = found_, kept](const RunContext& context) {
    makeThreadLast();
    if (!kept) {
      *found = checkRecording(session, context);
      return;
    }
    found->detected = forSession(*kept->detected, session);
    found->assessment = assessRecording(session, *found->detected, context);
  };
  runner_.start(tr("Check the recording"), checkStages(), work);
  emit started();
}

void RecordingCheckJob::finish(JobOutcome outcome) {
  const auto found = std::exchange(found_, nullptr);
  if (outcome == JobOutcome::Done && found && found->detected && session_) {
    detected_ = found;
    detected_for_ = found_for_;
  }
  if (outcome == JobOutcome::Done && !due_ && found) {
    checked_ = found;
    emit checkedAnew(checked_);
  }
  startSoon();
}

std::optional<DetectedRecording> RecordingCheckJob::detectedFor(const Session& session) const {
  if (!detected_ || !detectsTheSame(detected_for_, session)) return std::nullopt;
  return forSession(*detected_->detected, session);
}

}  // namespace evical::ui
