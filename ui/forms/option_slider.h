// SPDX-License-Identifier: GPL-3.0-or-later
// Slider for a number over its range, next to its input field: logarithmic if the range spans several powers
// of ten, and in integers if the option is one.
#pragma once

#include "core/base/option_row.h"

#include <QSlider>

namespace evical::ui {

class OptionSlider : public QSlider {
  Q_OBJECT

 public:
  // False for choices and for unbounded ranges.
  static bool fits(const OptionRow& row);

  OptionSlider(const OptionRow& row, QWidget* parent);

  void setShown(const QString& number);  // does not signal

 signals:
  void turning(const QString& number);  // during a drag
  void turned(const QString& number);   // at the end of a drag, or by keys

 protected:
  void wheelEvent(QWheelEvent* event) override;  // the form scrolls

 private:
  QString numberAt(int position) const;

  double minimum_, maximum_;
  bool whole_, powers_;
};

}  // namespace evical::ui
