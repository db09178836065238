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

class OptionEditor : public QWidget {
  Q_OBJECT

 public:
  OptionEditor(const OptionRow& row, QWidget* parent);

  const OptionRow& row() const { return row_; }
  bool isChanged() const { return row_.value != row_.default_value; }
  bool matches(const QString& search) const;  // in name or help
  void setRow(const OptionRow& row);          // the value that holds
  void showProblem(const QString& text);      // why what was typed does not hold; empty: it does
  void forgetProblem();                       // unless something that was typed does not hold

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
  bool somethingElseIsTyped() const;
  void showChanged();

  OptionRow row_;
  QLineEdit* number_ = nullptr;  // one of these three
  QCheckBox* toggle_ = nullptr;
  QComboBox* choice_ = nullptr;
  QLabel* dot_;
  QLabel* problem_;
  QToolButton* reset_;
};

}  // namespace evical::ui
