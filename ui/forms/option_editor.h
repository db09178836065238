// SPDX-License-Identifier: GPL-3.0-or-later
// One option of a form: name, value, unit, help, reset; a dot where it differs from its default.
#pragma once

#include "core/base/option_row.h"

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
  void highlight(const QString& search);      // where it occurs
  void showIdle(const QString& why);          // it has no effect here; empty: it has
  void setRow(const OptionRow& row);          // the value that holds
  void refuse(const QString& why);        // the value that holds is shown again, and why the other one is not
  void showProblem(const QString& text);  // empty: there is none

  // "normal_flow.plane_radius_px" in px gives "plane radius".
  static QString shownName(const OptionRow& row);
  static QString rangeText(const OptionRow& row);

 signals:
  void edited(const QString& name, const QString& value);
  void takenBack();  // what holds was typed again

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QWidget* makeInput();
  void makeSlider(QGridLayout& grid, int row);
  QString helpText() const;
  void showValue();
  void showChanged();

  OptionRow row_;
  QLineEdit* number_ = nullptr;  // one of these three
  QCheckBox* toggle_ = nullptr;
  QComboBox* choice_ = nullptr;
  OptionSlider* slider_ = nullptr;  // of numbers
  QLabel *dot_, *name_, *help_, *idle_, *problem_;
  QToolButton* reset_;
};

}  // namespace evical::ui
