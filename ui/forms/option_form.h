// SPDX-License-Identifier: GPL-3.0-or-later
// All options as a form, made from the option tables: groups, search, help, reset, and a badge on what
// differs. What people usually turn comes first; a button shows the expert options. The form holds no values:
// it shows rows, and says what the person wants.
#pragma once

#include "core/base/option_row.h"

#include <QStringList>
#include <QWidget>

#include <map>
#include <vector>

class QHBoxLayout;
class QLabel;
class QLineEdit;
class QToolButton;
class QVBoxLayout;

namespace evical::ui {

class OptionEditor;
class OptionGroup;

class OptionForm : public QWidget {
  Q_OBJECT

 public:
  explicit OptionForm(QWidget* parent = nullptr);

  void setRows(const std::vector<OptionRow>& rows);
  // Next to the field: why what was typed there was refused; where another option excludes it, there, too.
  // Options that have no effect here, by name, and why; the others have.
  void setIdle(const std::map<QString, QString>& reasons);
  void showRefusal(const QString& name, const CalibrationError& error);

  OptionEditor* editor(const QString& name) const;  // null: no such option
  QStringList shownOptions() const;                 // that search and level leave
  void showExpert(bool shown);

 signals:
  void edited(const QString& name, const QString& value);
  void resetAllRequested();

 private:
  void build(const std::vector<OptionRow>& rows);
  void fillBar(QHBoxLayout& bar);
  QWidget* makeList();
  void filter();
  void forgetProblems();

  QLineEdit* search_;
  QToolButton* only_changed_;
  QToolButton* reset_all_;
  QLabel* nothing_;
  QToolButton* expert_;
  QVBoxLayout* groups_layout_;
  std::vector<OptionGroup*> groups_;
  std::map<QString, OptionEditor*> editors_;
};

}  // namespace evical::ui
