// SPDX-License-Identifier: GPL-3.0-or-later
// Looks through a recording in the background: which streams it has, and what is wrong with them.
#pragma once

#include "core/recording/inspection.h"
#include "ui/jobs/job_runner.h"

#include <memory>

namespace evical::ui {

class InspectionJob : public QObject {
  Q_OBJECT

 public:
  explicit InspectionJob(QObject* parent = nullptr);

  // Takes the place of an inspection that still runs.
  void start(const QString& recording);
  bool running() const { return runner_.running(); }

 signals:
  void started(const QString& recording);
  void progressed(double fraction);
  void inspected(const QString& recording, std::shared_ptr<const evical::Inspection> inspection);
  void failed(const QString& recording, const evical::ui::JobError& error);

 private:
  void run();
  void finish(JobOutcome outcome);

  JobRunner runner_;
  QString recording_, next_;
  std::shared_ptr<Inspection> inspection_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(std::shared_ptr<const evical::Inspection>)
