// SPDX-License-Identifier: GPL-3.0-or-later
// Editor of one option: name, value, unit, help, reset; a dot if it differs from its default.
#pragma once

#include "core/base/option_row.h"

#include <QSlider>
#include <QWidget>

class QCheckBox;
class QComboBox;
class QGridLayout;
class QLabel;
class QLineEdit;
class QToolButton;

namespace evical::ui {

class OptionSlider;

class OptionEditor : public QWidget {
  Q_OBJECT

 public:
  OptionEditor(const OptionRow& row, QWidget* parent);

  const OptionRow& row() const { return row_; }
  bool isChanged() const { return row_.value != row_.default_value; }
  bool matches(const QString& search) const;  // in name or help
  void highlight(const QString& search);      // highlights the occurrences
  void showIdle(const QString& why);          // reason why the option has no effect; empty: it has
  void setRow(const OptionRow& row);          // the current value
  void refuse(const QString& why);            // shows the current value again, and the reason
  void showProblem(const QString& text);      // empty: none

  // "normal_flow.plane_radius_px" in px gives "plane radius".
  static QString shownName(const OptionRow& row);
  static QString rangeText(const OptionRow& row);

 signals:
  void edited(const QString& name, const QString& value);
  void takenBack();  // the current value was typed again

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QWidget* makeInput();
  void placeNumber(QGridLayout& grid);
  void makeSlider(QGridLayout& grid);
  QString helpText() const;
  void showValue();
  void showChanged();

  OptionRow row_;
  QLineEdit* number_ = nullptr;  // one of these three is used
  QCheckBox* toggle_ = nullptr;
  QComboBox* choice_ = nullptr;
  OptionSlider* slider_ = nullptr;  // for numbers
  QLabel *dot_, *name_, *help_, *idle_, *problem_;
  QToolButton* reset_;
};

// Slider for a number over its range, next to its input field: logarithmic if the range spans several powers
// of ten, and in integers if the option is one.
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
