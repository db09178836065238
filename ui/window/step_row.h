// SPDX-License-Identifier: GPL-3.0-or-later
// One row of the steps panel.
#pragma once

#include <QWidget>

class QLabel;
class QProgressBar;

namespace evical::ui {

enum class StepState { Pending, Running, Done, Failed, Cancelled };

class StepRow : public QWidget {
  Q_OBJECT

 public:
  StepRow(const QString& title, bool sub_step, QWidget* parent);

  StepState state() const { return state_; }
  bool isSubStep() const { return sub_step_; }
  void setState(StepState state);
  void setFraction(double fraction);
  void setTime(double time_s);
  void setKeyNumber(const QString& text, const QString& in_full = {});
  QString text() const;

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void showState();

  StepState state_ = StepState::Pending;
  bool sub_step_;
  QLabel* icon_;
  QLabel* title_;
  QLabel* time_;
  QLabel* key_;
  QProgressBar* bar_;
  QString key_in_full_;
};

}  // namespace evical::ui
