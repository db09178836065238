// SPDX-License-Identifier: GPL-3.0-or-later
// Inspects recordings in the background, one after the other: their streams and faults.
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

  // Replaces running and waiting inspections.
  void start(const QStringList& recordings);
  // Queued after the running and waiting ones.
  void add(const QString& recording);
  bool running() const { return runner_.running(); }

 signals:
  void restarted();  // earlier inspections are obsolete
  void started(const QString& recording);
  void progressed(double fraction);
  void inspected(const QString& recording, std::shared_ptr<const evical::Inspection> inspection);
  void failed(const QString& recording, const evical::ui::JobError& error);

 private:
  void next();
  void finish(JobOutcome outcome);

  JobRunner runner_;
  QString recording_;  // being inspected; empty if obsolete
  QStringList waiting_;
  std::shared_ptr<Inspection> inspection_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(std::shared_ptr<const evical::Inspection>)
