// SPDX-License-Identifier: GPL-3.0-or-later
// Form of all options, made from the option tables: groups, search, help, reset, and a badge on changed ones.
// Common options are first; a button also shows the expert ones. Tuning options are not in the rows. The form
// stores no values: it shows rows and emits edits.
#pragma once

#include "core/base/option_row.h"
#include "ui/forms/option_editor.h"

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
  // Shows next to the field why the typed value was refused; also at another option that excludes it.
  // Options without effect, by name, with the reasons; the others have an effect.
  void setIdle(const std::map<QString, QString>& reasons);
  void showRefusal(const QString& name, const CalibrationError& error);

  OptionEditor* editor(const QString& name) const;  // null: unknown option
  QStringList shownOptions() const;                 // options that match search and level
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

// Options of one stage under a heading that collapses them.
class OptionGroup : public QWidget {
  Q_OBJECT

 public:
  OptionGroup(const QString& title, QWidget* parent);

  void add(OptionEditor* editor);
  // Shows the matching options; expands during a search. Expert options at their defaults are shown with
  // `with_expert`, or if a search finds them.
  void filter(const QString& search, bool only_changed, bool with_expert);
  void showChangedCount();
  bool anyShown() const { return any_shown_; }
  const std::vector<OptionEditor*>& editors() const { return editors_; }

 private:
  void showBody();

  QToolButton* heading_;
  QLabel* badge_;
  QWidget* body_;
  QVBoxLayout* body_layout_;
  std::vector<OptionEditor*> editors_;
  bool any_shown_ = true, searching_ = false;
};

}  // namespace evical::ui
