// SPDX-License-Identifier: GPL-3.0-or-later
// Panel with an error, its place and advice: above the screens, never covering them.
#pragma once

#include "ui/jobs/job_runner.h"

#include <QFrame>
#include <QStringList>

class QLabel;

namespace evical::ui {

class RepairButton;

class ErrorPanel : public QFrame {
  Q_OBJECT

 public:
  explicit ErrorPanel(QWidget* parent = nullptr);

  void showError(const QString& what_was_tried, const JobError& error);
  void dismiss();
  QString text() const;

 signals:
  void repairRequested(const evical::Repair& repair);

 protected:
  void changeEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void showIcon();

  QLabel* icon_;
  QLabel* title_;
  QLabel* problem_;
  QLabel* advice_;
  RepairButton* repair_;
};

}  // namespace evical::ui

// Notice of an export: its folder, its files, and what was refused. Below the screens, which keep their
// places, until it is dismissed.

class QLabel;

namespace evical::ui {

struct ExportOutcome {
  QString folder;
  QStringList programs;   // programs with files
  QStringList refused;    // each with the reason
  bool checked = false;   // the files were read back
  QStringList differing;  // programs that read other values than the result's
  QString title = {};     // title if something else than a result was written
};

class ExportNotice : public QFrame {
  Q_OBJECT

 public:
  explicit ExportNotice(QWidget* parent = nullptr);

  void showOutcome(const ExportOutcome& outcome);
  QString text() const;

 protected:
  void changeEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void openFolder();
  void showIcon();

  QString folder_;
  bool whole_ = true;  // nothing was refused, and all values agree
  QLabel *icon_, *title_, *place_, *details_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(evical::ui::ExportOutcome)
