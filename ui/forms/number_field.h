// SPDX-License-Identifier: GPL-3.0-or-later
// A line for one number, in plain or scientific notation; says what is wrong with what was typed.
#pragma once

#include <QLineEdit>

namespace evical::ui {

class NumberField : public QLineEdit {
  Q_OBJECT

 public:
  NumberField(double minimum, double maximum, QWidget* parent = nullptr);

  void setValue(double value);  // does not signal
  double value() const { return value_; }
  bool isWrong() const { return wrong_; }

 signals:
  void valueEdited(double value);  // by hand, within the range, and different

 private:
  void take();
  void showWrong(const QString& why);

  double minimum_, maximum_, value_ = 0.0;
  bool wrong_ = false;
  QString help_;  // the tip while nothing is wrong
};

}  // namespace evical::ui
