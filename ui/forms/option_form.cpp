// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_form.h"

#include "ui/forms/option_group.h"
#include "ui/theme/theme.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QScrollArea>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace evical::ui {
namespace {

QString groupTitle(const std::string& option_name) {
  QString title = QString::fromStdString(option_name).section('.', 0, 0).replace('_', ' ');
  if (!title.isEmpty()) title[0] = title[0].toUpper();
  return title;
}

}  // namespace

OptionForm::OptionForm(QWidget* parent)
    : QWidget(parent),
      search_(new QLineEdit(this)),
      only_changed_(new QToolButton(this)),
      reset_all_(new QToolButton(this)),
      nothing_(new QLabel(tr("No parameter matches."), this)),
      groups_layout_(nullptr) {
  search_->setPlaceholderText(tr("Search parameters"));
  search_->setClearButtonEnabled(true);
  search_->addAction(icon("search"), QLineEdit::LeadingPosition);
  only_changed_->setIcon(icon("filter"));
  only_changed_->setCheckable(true);
  only_changed_->setToolTip(tr("Show only what differs from its default"));
  reset_all_->setIcon(icon("reset"));
  reset_all_->setToolTip(tr("All parameters back to their defaults"));
  nothing_->setProperty("role", "hint");
  nothing_->hide();
  connect(search_, &QLineEdit::textChanged, this, &OptionForm::filter);
  connect(only_changed_, &QToolButton::toggled, this, &OptionForm::filter);
  connect(reset_all_, &QToolButton::clicked, this, &OptionForm::resetAllRequested);

  auto* const bar = new QHBoxLayout;
  bar->addWidget(search_, 1);
  bar->addWidget(only_changed_);
  bar->addWidget(reset_all_);
  auto* const scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* const content = new QWidget(scroll);
  groups_layout_ = new QVBoxLayout(content);
  groups_layout_->setContentsMargins(0, 0, 4, 0);
  groups_layout_->setSpacing(2);
  groups_layout_->addStretch();
  scroll->setWidget(content);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 8, 4, 8);
  layout->addLayout(bar);
  layout->addWidget(nothing_);
  layout->addWidget(scroll, 1);
  constexpr int kLeast_px = 300;
  setMinimumWidth(kLeast_px);
}

void OptionForm::build(const std::vector<OptionRow>& rows) {
  QString last_title;
  for (const OptionRow& row : rows) {
    const QString title = groupTitle(row.name);
    if (title != last_title) {
      groups_.push_back(new OptionGroup(title, this));
      groups_layout_->insertWidget(groups_layout_->count() - 1, groups_.back());
      last_title = title;
    }
    auto* const made = new OptionEditor(row, groups_.back());
    connect(made, &OptionEditor::edited, this, &OptionForm::edited);
    groups_.back()->add(made);
    editors_[QString::fromStdString(row.name)] = made;
  }
}

void OptionForm::setRows(const std::vector<OptionRow>& rows) {
  if (editors_.empty()) build(rows);
  bool any_changed = false;
  for (const OptionRow& row : rows) {
    const auto found = editors_.find(QString::fromStdString(row.name));
    if (found == editors_.end()) continue;
    found->second->setRow(row);
    any_changed = any_changed || found->second->isChanged();
  }
  for (OptionGroup* const group : groups_) group->showChangedCount();
  reset_all_->setEnabled(any_changed);
  if (only_changed_->isChecked()) filter();
}

void OptionForm::showProblem(const QString& name, const QString& text) {
  if (OptionEditor* const found = editor(name)) found->showProblem(text);
}

void OptionForm::filter() {
  bool any = false;
  for (OptionGroup* const group : groups_) {
    group->filter(search_->text().trimmed(), only_changed_->isChecked());
    any = any || group->anyShown();
  }
  nothing_->setVisible(!any && !groups_.empty());
}

OptionEditor* OptionForm::editor(const QString& name) const {
  const auto found = editors_.find(name);
  return found == editors_.end() ? nullptr : found->second;
}

QStringList OptionForm::shownOptions() const {
  QStringList names;
  for (const OptionGroup* const group : groups_) {
    for (const OptionEditor* const option : group->editors())
      if (!option->isHidden()) names << QString::fromStdString(option->row().name);
  }
  return names;
}

}  // namespace evical::ui
