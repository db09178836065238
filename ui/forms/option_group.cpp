// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_group.h"

#include "ui/theme/theme.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace evical::ui {

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
