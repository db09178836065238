// SPDX-License-Identifier: GPL-3.0-or-later
// Notice of an export: its folder, its files, and what was refused. Below the screens, which keep their
// places, until it is dismissed.
#pragma once

#include <QFrame>
#include <QStringList>

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
