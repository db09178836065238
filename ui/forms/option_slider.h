// SPDX-License-Identifier: GPL-3.0-or-later
// Turns a number over its range, beside the field in which it is typed: in powers where the range spans several, and in
// whole numbers where the option has no others.
#pragma once

#include "core/base/option_row.h"

#include <QSlider>

namespace evical::ui {

class OptionSlider : public QSlider {
  Q_OBJECT

 public:
  // False of choices, and of ranges that don't end.
  static bool fits(const OptionRow& row);

  OptionSlider(const OptionRow& row, QWidget* parent);

  void setShown(const QString& number);  // does not signal

 signals:
  void turning(const QString& number);  // while the mouse holds it
  void turned(const QString& number);   // let go, or moved by keys

 protected:
  void wheelEvent(QWheelEvent* event) override;  // the form scrolls

 private:
  QString numberAt(int position) const;

  double minimum_, maximum_;
  bool whole_, powers_;
};

}  // namespace evical::ui
