// SPDX-License-Identifier: GPL-3.0-or-later
// Panel with an error, its place and advice: above the screens, never covering them.
#pragma once

#include "ui/jobs/job_runner.h"

#include <QFrame>

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
