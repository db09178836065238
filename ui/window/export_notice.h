// SPDX-License-Identifier: GPL-3.0-or-later
// Where an export went, what is in it, and what could not be: above the screens, until it is dismissed.
#pragma once

#include <QFrame>
#include <QStringList>

class QLabel;

namespace evical::ui {

struct ExportOutcome {
  QString folder;
  QStringList programs;   // that have files
  QStringList refused;    // each with the reason
  bool checked = false;   // the files were read back
  QStringList differing;  // those that do not say what the result says
  QString title = {};     // of what was written, where it is no result
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
  bool whole_ = true;  // nothing was refused, and nothing differs
  QLabel *icon_, *title_, *place_, *details_;
};

}  // namespace evical::ui

Q_DECLARE_METATYPE(evical::ui::ExportOutcome)
