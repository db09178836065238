// SPDX-License-Identifier: GPL-3.0-or-later
// Looks by itself whether the recording is good enough, behind all that people ask for: it stops where a job of theirs
// begins, and starts anew afterwards. What it detects is kept, so that a calibration need not detect it again.
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

  // Off: nothing starts by itself, and what runs stops.
  void setAutomatic(bool automatic);
  bool automatic() const { return automatic_; }

  // What is to be checked from now on, once it has not changed for a moment; nothing: there is nothing that could be.
  void setSession(std::optional<Session> session);
  // The recording has grown: once more, all of it, also where nothing starts by itself. What was found stays until then.
  void lookAgain();
  // Somebody waits for other work.
  void giveWay(bool busy);

  bool running() const { return runner_.running(); }
  // It runs, or will; somebody who waits for it will hear.
  bool awaited() const { return mayStart() && session_ && (due_ || (runner_.running() && !checked_)); }
  // Of the session as it was set last; null while it is not known.
  const std::shared_ptr<const CheckedRecording>& checked() const { return checked_; }
  // What a calibration of this session may start from.
  std::optional<DetectedRecording> detectedFor(const Session& session) const;

 signals:
  void outdated();  // what was checked is of no more interest
  void started();
  void interrupted();  // it stopped, and will start anew
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
  bool asked_ = false;              // for a look at this session
  std::optional<Session> session_;  // to be checked
  bool due_ = false;                // it has changed since what runs began, or nothing has run
  // What was found, and for which session; written by the work, read once it has ended.
  std::shared_ptr<CheckedRecording> found_;
  Session found_for_;
  std::shared_ptr<const CheckedRecording> checked_,
      detected_;  // the second: the last one that has detections
  Session detected_for_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(std::shared_ptr<const evical::CheckedRecording>)
