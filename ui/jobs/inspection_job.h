// SPDX-License-Identifier: GPL-3.0-or-later
// Looks through recordings in the background, one after the other: which streams they have, and
// what is wrong with them.
#pragma once

#include "core/recording/inspection.h"
#include "ui/jobs/job_runner.h"

#include <QStringList>

#include <memory>

namespace evical::ui {

class InspectionJob : public QObject {
  Q_OBJECT

 public:
  explicit InspectionJob(QObject* parent = nullptr);

  // Takes the place of inspections that still run or wait.
  void start(const QStringList& recordings);
  // After those that run or wait.
  void add(const QString& recording);
  bool running() const { return runner_.running(); }

 signals:
  void restarted();  // whatever was inspected before is of no more interest
  void started(const QString& recording);
  void progressed(double fraction);
  void inspected(const QString& recording, std::shared_ptr<const evical::Inspection> inspection);
  void failed(const QString& recording, const evical::ui::JobError& error);

 private:
  void next();
  void finish(JobOutcome outcome);

  JobRunner runner_;
  QString recording_;  // that is looked through; none once it is of no more interest
  QStringList waiting_;
  std::shared_ptr<Inspection> inspection_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(std::shared_ptr<const evical::Inspection>)
