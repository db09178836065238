// SPDX-License-Identifier: GPL-3.0-or-later
// Cards about what has happened, until they are dismissed: errors above the screens, never covering them, and
// exports below, which keep their places.
#pragma once

#include "ui/jobs/job_runner.h"

#include <QFrame>
#include <QIcon>
#include <QStringList>

class QGridLayout;
class QLabel;

namespace evical::ui {

class RepairButton;

// An icon, a heading, two texts, and a button to close it, as Esc does.
class NoticeCard : public QFrame {
 public:
  QString text() const;

 protected:
  NoticeCard(const QString& name, QWidget* parent);
  virtual QIcon sign() const = 0;
  void present();  // shows the card with its texts; empty ones are hidden
  void changeEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

  QGridLayout* grid_;  // columns: icon, texts, actions, button to close
  QLabel *title_, *body_, *details_;

 private:
  void showIcon();

  QLabel* icon_;
};

// An error, its place and advice.
class ErrorPanel : public NoticeCard {
  Q_OBJECT

 public:
  explicit ErrorPanel(QWidget* parent = nullptr);

  void showError(const QString& what_was_tried, const JobError& error);

 signals:
  void repairRequested(const evical::Repair& repair);

 protected:
  QIcon sign() const override;

 private:
  RepairButton* repair_;
};

struct ExportOutcome {
  QString folder;
  QStringList programs;   // programs with files
  QStringList refused;    // each with the reason
  bool checked = false;   // the files were read back
  QStringList differing;  // programs that read other values than the result's
  QString title = {};     // title if something else than a result was written
};

// An export: its folder, its files, and what was refused.
class ExportNotice : public NoticeCard {
  Q_OBJECT

 public:
  explicit ExportNotice(QWidget* parent = nullptr);

  void showOutcome(const ExportOutcome& outcome);

 protected:
  QIcon sign() const override;

 private:
  void openFolder();

  QString folder_;
  bool whole_ = true;  // nothing was refused, and all values agree
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(evical::ui::ExportOutcome)
