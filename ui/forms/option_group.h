// SPDX-License-Identifier: GPL-3.0-or-later
// Options of one stage under a heading that collapses them.
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
