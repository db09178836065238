// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_form.h"

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

// "optimisation.solver.threads" gives "Optimisation: solver".
QString groupTitle(const std::string& option_name) {
  QString title = QString::fromStdString(option_name).section('.', 0, -2);
  title.replace(".", ": ").replace('_', ' ');
  if (!title.isEmpty()) title[0] = title[0].toUpper();
  return title;
}

QString valueOf(const OptionEditor& editor) {
  return QString::fromStdString(editor.row().value + " " + editor.row().unit).trimmed();
}

}  // namespace

OptionForm::OptionForm(QWidget* parent)
    : QWidget(parent),
      search_(new QLineEdit(this)),
      only_changed_(new QToolButton(this)),
      reset_all_(new QToolButton(this)),
      nothing_(new QLabel(tr("No parameter matches."), this)),
      expert_(new QToolButton(this)),
      groups_layout_(nullptr) {
  nothing_->setProperty("role", "hint");
  nothing_->hide();
  expert_->setObjectName("expert");
  expert_->setCheckable(true);
  expert_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  expert_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  connect(expert_, &QToolButton::toggled, this, &OptionForm::filter);
  auto* const bar = new QHBoxLayout;
  fillBar(*bar);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 8, 4, 8);
  layout->addLayout(bar);
  layout->addWidget(nothing_);
  layout->addWidget(makeList(), 1);
  layout->addWidget(expert_);
  constexpr int kMin_px = 270;  // fits the widest row, one with a long unit
  setMinimumWidth(kMin_px);
}

void OptionForm::fillBar(QHBoxLayout& bar) {
  search_->setPlaceholderText(tr("Search parameters"));
  search_->setClearButtonEnabled(true);
  search_->addAction(icon("search"), QLineEdit::LeadingPosition);
  only_changed_->setIcon(icon("filter"));
  only_changed_->setCheckable(true);
  search_->setAccessibleName(tr("Search parameters"));
  only_changed_->setAccessibleName(tr("Show changed parameters only"));
  reset_all_->setAccessibleName(tr("Reset all parameters to their defaults"));
  only_changed_->setToolTip(tr("Show changed parameters only"));
  reset_all_->setIcon(icon("reset"));
  reset_all_->setToolTip(tr("Reset all parameters to their defaults"));
  connect(search_, &QLineEdit::textChanged, this, &OptionForm::filter);
  connect(only_changed_, &QToolButton::toggled, this, &OptionForm::filter);
  connect(reset_all_, &QToolButton::clicked, this, &OptionForm::resetAllRequested);
  bar.addWidget(search_, 1);
  bar.addWidget(only_changed_);
  bar.addWidget(reset_all_);
}

QWidget* OptionForm::makeList() {
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
  return scroll;
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
    connect(made, &OptionEditor::takenBack, this, &OptionForm::forgetProblems);
    connect(made, &OptionEditor::edited, this, [this](const QString& name, const QString& value) {
      forgetProblems();
      emit edited(name, value);
    });
    groups_.back()->add(made);
    editors_[QString::fromStdString(row.name)] = made;
  }
  filter();
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
  filter();
}

void OptionForm::setIdle(const std::map<QString, QString>& reasons) {
  for (const auto& [name, option] : editors_) {
    const auto found = reasons.find(name);
    option->showIdle(found == reasons.end() ? QString() : found->second);
  }
}

void OptionForm::showRefusal(const QString& name, const CalibrationError& error) {
  QStringList places = {name};
  QString text = QString::fromStdString(error.problem());
  if (const auto* const conflict = dynamic_cast<const OptionConflict*>(&error)) {
    places = {QString::fromStdString(conflict->lower()), QString::fromStdString(conflict->upper())};
    text += ". " + QString::fromStdString(error.advice());
  }
  for (const QString& place : places) {
    OptionEditor* const found = editor(place);
    if (found && place == name) found->refuse(tr("%1. It stays at %2.").arg(text, valueOf(*found)));
    if (found && place != name) found->showProblem(text);
  }
}

// Problems are cleared by the next edit of any option.
void OptionForm::forgetProblems() {
  for (const auto& [name, option] : editors_) option->showProblem({});
}

void OptionForm::showExpert(bool shown) {
  expert_->setChecked(shown);
}

void OptionForm::filter() {
  bool any = false;
  for (OptionGroup* const group : groups_) {
    group->filter(search_->text().trimmed(), only_changed_->isChecked(), expert_->isChecked());
    any = any || group->anyShown();
  }
  const auto count = std::count_if(editors_.begin(), editors_.end(), [](const auto& editor) {
    return editor.second->row().level == Level::Expert;
  });
  expert_->setText(expert_->isChecked() ? tr("Fewer options") : tr("More options (%1)").arg(count));
  expert_->setIcon(icon(expert_->isChecked() ? "up" : "down"));
  expert_->setVisible(search_->text().trimmed().isEmpty() && !only_changed_->isChecked());
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

OptionGroup::OptionGroup(const QString& title, QWidget* parent)
    : QWidget(parent),
      heading_(new QToolButton(this)),
      badge_(new QLabel(this)),
      body_(new QWidget(this)),
      body_layout_(new QVBoxLayout(body_)) {
  heading_->setObjectName("group");
  heading_->setText(title);
  heading_->setCheckable(true);
  heading_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  heading_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  heading_->setStyleSheet("QToolButton { text-align: left; font-weight: 600; background: transparent; }");
  badge_->setProperty("role", "hint");
  connect(heading_, &QToolButton::toggled, this, &OptionGroup::showBody);
  body_layout_->setContentsMargins(6, 0, 0, 6);
  body_layout_->setSpacing(0);
  auto* const line = new QHBoxLayout;
  line->addWidget(heading_, 1);
  line->addWidget(badge_);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addLayout(line);
  layout->addWidget(body_);
  showBody();
}

void OptionGroup::add(OptionEditor* editor) {
  editors_.push_back(editor);
  body_layout_->addWidget(editor);
}

void OptionGroup::filter(const QString& search, bool only_changed, bool with_expert) {
  any_shown_ = false;
  searching_ = !search.isEmpty() || only_changed;
  for (OptionEditor* const editor : editors_) {
    const bool folded =
        editor->row().level == Level::Expert && !with_expert && !searching_ && !editor->isChanged();
    const bool shown = !folded && editor->matches(search) && (!only_changed || editor->isChanged());
    editor->setVisible(shown);
    editor->highlight(search);
    any_shown_ = any_shown_ || shown;
  }
  setVisible(any_shown_);
  showBody();
}

void OptionGroup::showChangedCount() {
  const auto changed = std::count_if(editors_.begin(), editors_.end(),
                                     [](const OptionEditor* editor) { return editor->isChanged(); });
  badge_->setText(changed == 0 ? QString() : tr("%1 changed").arg(changed));
}

void OptionGroup::showBody() {
  const bool open = heading_->isChecked() || searching_;
  heading_->setIcon(icon(open ? "down" : "right"));
  body_->setVisible(open);
}

}  // namespace evical::ui
