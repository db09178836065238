// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic check whether the recording is good enough, with lower priority than the user's jobs: it stops
// when one of them starts, and restarts afterwards. Its detections are kept for a calibration.
#pragma once

#include "core/pipeline/rig/recording_assessment.h"
#include "ui/jobs/job_runner.h"

#include <QObject>
#include <QTimer>

#include <memory>
#include <optional>

namespace evical::ui {

class RecordingCheckJob : public QObject {
  Q_OBJECT

 public:
  explicit RecordingCheckJob(QObject* parent = nullptr);

  // Off: nothing starts automatically, and a running check stops.
  void setAutomatic(bool automatic);
  bool automatic() const { return automatic_; }

  // Session to check from now on, after a moment without changes; none: nothing to check.
  void setSession(std::optional<Session> session);
  // The recording has grown: checks all of it again, even if automatic checks are disabled. The last
  // assessment stays until then.
  void lookAgain();
  // Another job is waiting or running.
  void giveWay(bool busy);

  bool running() const { return runner_.running(); }
  // A check is running or due; its end will be signalled.
  bool awaited() const { return mayStart() && session_ && (due_ || (runner_.running() && !checked_)); }
  // For the session that was set last; null while unknown.
  const std::shared_ptr<const CheckedRecording>& checked() const { return checked_; }
  // Detections from which a calibration of this session may start.
  std::optional<DetectedRecording> detectedFor(const Session& session) const;

 signals:
  void outdated();  // the last check is obsolete
  void started();
  void interrupted();  // stopped, and will restart
  void progressed(double fraction);
  void checkedAnew(std::shared_ptr<const evical::CheckedRecording> checked);
  void failed(const evical::ui::JobError& error);

 private:
  bool mayStart() const { return automatic_ || asked_; }
  void startSoon();
  void start();
  void finish(JobOutcome outcome);

  JobRunner runner_;
  QTimer pause_;
  bool automatic_ = true, busy_ = false;
  bool asked_ = false;              // lookAgain() was called for this session
  std::optional<Session> session_;  // session to check
  bool due_ = false;                // changed since the running check started, or never checked
  // Result and its session; written by the work, read after its end.
  std::shared_ptr<CheckedRecording> found_;
  Session found_for_;
  std::shared_ptr<const CheckedRecording> checked_,
      detected_;  // the latest check, and the latest one with detections
  Session detected_for_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(std::shared_ptr<const evical::CheckedRecording>)
