// SPDX-License-Identifier: GPL-3.0-or-later
// A line for one number, in plain or scientific notation. What is none, or out of range, gives way to the value that
// holds, with a mark that says why.
#pragma once

#include <QLineEdit>

namespace evical::ui {

class NumberField : public QLineEdit {
  Q_OBJECT

 public:
  NumberField(double minimum, double maximum, QWidget* parent = nullptr);

  void setValue(double value);  // does not signal
  double value() const { return value_; }
  bool hasRefused() const;  // what was typed last

 signals:
  void valueEdited(double value);  // by hand, within the range, and different

 private:
  void take();
  void refuse(const QString& why);

  double minimum_, maximum_, value_ = 0.0;
  QAction* refused_;  // the mark
};

}  // namespace evical::ui
