// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of a calibration in order, each with its state, progress, duration and key number.
#pragma once

#include "core/data/calibration_observer.h"
#include "ui/document/calibration_aim.h"
#include "ui/jobs/calibration_job.h"
#include "ui/jobs/intrinsics_job.h"
#include "ui/jobs/job_runner.h"

#include <QWidget>

#include <map>
#include <optional>

class QVBoxLayout;
class QLabel;
class QProgressBar;

namespace evical::ui {

class StepRow;

class StepsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit StepsPanel(QWidget* parent = nullptr);

  void reset();
  void setAim(CalibrationAim aim);        // whose steps are shown; they remain after a run
  void startStage(const QString& stage);  // by name (core/data/calibration_observer.h)
  void setProgress(const JobProgress& progress);
  void setDetections(const LiveDetections& detections);
  void addInitialisationNote(const InitialisationNote& note);
  void setIterations(const LiveIterations& iterations);
  void setPass(const LensPass& pass);  // for a camera alone
  void finish(JobOutcome outcome);
  void setRun(const CalibrationRun& run);  // the final numbers

  // For tests and screen readers: "Optimise: done, ...".
  QString textOf(const QString& step) const;

 private:
  void dropUnusedSteps();
  void showSubSteps(bool shown);  // only while they run: they are details
  void addStages();
  void startPass(const QString& stage);
  // `step_of`: the stage of this step; none: it is a stage.
  StepRow* addRow(const QString& key, const QString& title, std::optional<CalibrationStage> step_of = {});
  StepRow* rowAfter(const QString& key,
                    std::optional<CalibrationStage> step_of);  // null: none follows
  StepRow* row(const QString& key);
  StepRow* row(CalibrationStage stage);

  QVBoxLayout* layout_;
  std::map<QString, StepRow*> rows_;
  bool sub_steps_shown_ = false;
  CalibrationAim aim_ = CalibrationAim::Rig;
  QString stage_;
  double stage_begin_s_ = 0.0, elapsed_s_ = 0.0;
  double counted_s_ = -1.0, timed_s_ = -1.0;  // time of the last update of windows and seconds
};

// One row of the steps panel.
enum class StepState { Pending, Running, Done, Failed, Cancelled };

class StepRow : public QWidget {
  Q_OBJECT

 public:
  StepRow(const QString& title, bool sub_step, QWidget* parent);

  StepState state() const { return state_; }
  bool isSubStep() const { return sub_step_; }
  void setState(StepState state);
  void setFraction(double fraction);
  void setTime(double time_s);
  void setKeyNumber(const QString& text, const QString& in_full = {});
  QString text() const;

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void showState();

  StepState state_ = StepState::Pending;
  bool sub_step_;
  QLabel* icon_;
  QLabel* title_;
  QLabel* time_;
  QLabel* key_;
  QProgressBar* bar_;
  QString key_in_full_;
};

}  // namespace evical::ui
