// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/work_bar.h"

#include "ui/theme/theme.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>

namespace evical::ui {

WorkBar::WorkBar(const QString& name, const QString& icon_name, const QString& title, const QString& tip,
                 QWidget* parent)
    : QWidget(parent),
      start_(new QPushButton(icon(icon_name, QPalette::HighlightedText), title, this)),
      cancel_(new QPushButton(icon("cancel"), tr("Cancel"), this)),
      bar_(new QProgressBar(this)),
      words_(new QLabel(this)),
      layout_(new QHBoxLayout(this)),
      tip_(tip) {
  constexpr int kBar_px = 140, kSteps = 1000;
  start_->setObjectName("start_" + name);
  start_->setProperty("primary", true);
  cancel_->setObjectName("cancel_" + name);
  cancel_->setToolTip(tr("Cancel the job (Shift+F5)"));
  bar_->setRange(0, kSteps);
  bar_->setTextVisible(false);
  bar_->setFixedWidth(kBar_px);
  bar_->setAccessibleName(tr("Progress"));
  words_->setProperty("role", "hint");
  words_->setWordWrap(true);
  connect(start_, &QPushButton::clicked, this, &WorkBar::startRequested);
  connect(cancel_, &QPushButton::clicked, this, &WorkBar::cancelRequested);
  layout_->setContentsMargins(0, 0, 0, 0);
  for (QWidget* const widget :
       {static_cast<QWidget*>(start_), static_cast<QWidget*>(cancel_), static_cast<QWidget*>(bar_)})
    layout_->addWidget(widget);
  layout_->addWidget(words_, 1);
  offer();
}

void WorkBar::addButton(QPushButton* button) {
  layout_->addWidget(button);
}

void WorkBar::setHindrance(const QString& why) {
  hindrance_ = why;
  offer();
}

void WorkBar::setRunning(bool own, bool other) {
  if (own && !own_) bar_->setValue(0);
  own_ = own;
  other_ = other;
  offer();
}

void WorkBar::setProgress(const QString& stage, double fraction) {
  if (!own_) return;
  bar_->setValue(static_cast<int>(bar_->maximum() * fraction));
  words_->setText(stage);
}

void WorkBar::offer() {
  start_->setVisible(!own_);
  cancel_->setVisible(own_);
  bar_->setVisible(own_);
  start_->setEnabled(!other_ && hindrance_.isEmpty());
  const QString why = other_ ? tr("Another job is running") : hindrance_;
  start_->setToolTip(why.isEmpty() ? tip_ : why);
  words_->setText(own_ ? QString() : why);
}

}  // namespace evical::ui
