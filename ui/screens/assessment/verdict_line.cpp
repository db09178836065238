// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/verdict_line.h"

#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

QIcon markOf(VerdictTone tone) {
  switch (tone) {
    case VerdictTone::Good:
      return icon("done", theme().good);
    case VerdictTone::Bad:
      return icon("error", theme().bad);
    case VerdictTone::Doubtful:
      break;
  }
  return icon("warning", theme().warning);
}

}  // namespace

VerdictLine::VerdictLine(const QString& name, QWidget* parent)
    : QWidget(parent),
      mark_(new QLabel(this)),
      title_(selectableLabel("title", this)),
      reason_(selectableLabel("", this)),
      lines_(new QVBoxLayout) {
  title_->setObjectName(name + "_verdict");
  reason_->setObjectName(name + "_reason");
  lines_->setSpacing(2);
  lines_->addWidget(title_);
  lines_->addWidget(reason_);
  auto* const layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(12);
  layout->addWidget(mark_, 0, Qt::AlignTop);
  layout->addLayout(lines_, 1);
}

void VerdictLine::addLine(QWidget* line) {
  lines_->addWidget(line);
}

void VerdictLine::setVerdict(VerdictTone tone, const QString& title, const QString& reason) {
  tone_ = tone;
  title_->setText(title);
  title_->setAccessibleName(title);
  reason_->setText(reason);
  reason_->setVisible(!reason.isEmpty());
  paintMark();
}

void VerdictLine::paintMark() {
  constexpr int kMark_px = 34;
  mark_->setPixmap(markOf(tone_).pixmap(QSize(kMark_px, kMark_px), devicePixelRatioF()));
}

void VerdictLine::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) paintMark();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
