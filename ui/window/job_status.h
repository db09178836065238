// SPDX-License-Identifier: GPL-3.0-or-later
// Status bar widget of the running job: its name, progress and remaining time.
#pragma once

#include "ui/jobs/job_runner.h"

#include <QWidget>

class QLabel;
class QProgressBar;

namespace evical::ui {

class JobStatus : public QWidget {
  Q_OBJECT

 public:
  explicit JobStatus(const JobRunner& runner, QWidget* parent = nullptr);

  QString text() const;
  void reset();  // forgets the last job, unless one is running
  // A recording that is being read without a job of the window; empty: none.
  void setReading(const QString& recording);

 private:
  void begin(const QString& title);
  void setProgress(const JobProgress& progress);
  void end(JobOutcome outcome);

  const JobRunner& runner_;
  QLabel* what_;
  QProgressBar* bar_;
  QLabel* time_left_;
};

// "25 s", "3 min 20 s"
QString durationText(double duration_s);

}  // namespace evical::ui
