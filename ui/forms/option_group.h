// SPDX-License-Identifier: GPL-3.0-or-later
// The options of one stage under a heading that folds them away.
#pragma once

#include "ui/forms/option_editor.h"

#include <QWidget>

#include <vector>

class QLabel;
class QToolButton;
class QVBoxLayout;

namespace evical::ui {

class OptionGroup : public QWidget {
  Q_OBJECT

 public:
  OptionGroup(const QString& title, QWidget* parent);

  void add(OptionEditor* editor);
  // Shows those that match; unfolds while something is searched for. Expert options that are at their default
  // are shown if `with_expert` says so, or a search finds them.
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
