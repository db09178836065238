// SPDX-License-Identifier: GPL-3.0-or-later
// Job of a page: the button that starts it, its progress, the button that cancels it.
#pragma once

#include <QWidget>

class QHBoxLayout;
class QLabel;
class QProgressBar;
class QPushButton;

namespace evical::ui {

class WorkBar : public QWidget {
  Q_OBJECT

 public:
  WorkBar(const QString& name, const QString& icon_name, const QString& title, const QString& tip,
          QWidget* parent);

  void addButton(QPushButton* button);  // at the right end
  // Reason why the job cannot start, next to the button; empty: it can.
  void setHindrance(const QString& why);
  void setRunning(bool own, bool other);
  void setProgress(const QString& stage, double fraction);

 signals:
  void startRequested();
  void cancelRequested();

 private:
  void offer();

  QPushButton *start_, *cancel_;
  QProgressBar* bar_;
  QLabel* words_;
  QHBoxLayout* layout_;
  QString tip_, hindrance_;
  bool own_ = false, other_ = false;
};

}  // namespace evical::ui
