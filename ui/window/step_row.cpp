// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/step_row.h"

#include "ui/theme/theme.h"

#include <QEvent>
#include <QGridLayout>
#include <QLabel>
#include <QProgressBar>

namespace evical::ui {
namespace {

QString stateWord(StepState state) {
  switch (state) {
    case StepState::Pending:
      return QObject::tr("waiting");
    case StepState::Running:
      return QObject::tr("running");
    case StepState::Done:
      return QObject::tr("done");
    case StepState::Failed:
      return QObject::tr("failed");
    case StepState::Cancelled:
      return QObject::tr("cancelled");
  }
  return {};
}

QIcon stateIcon(StepState state) {
  const Theme& t = theme();
  switch (state) {
    case StepState::Pending:
      return icon("pending", t.faint_text);
    case StepState::Running:
      return icon("running", t.accent);
    case StepState::Done:
      return icon("done", t.good);
    case StepState::Failed:
      return icon("error", t.bad);
    case StepState::Cancelled:
      return icon("ignore", t.warning);
  }
  return {};
}

QLabel* smallLabel(QWidget* parent) {
  auto* const label = new QLabel(parent);
  label->setProperty("role", "hint");
  QFont font = label->font();
  font.setPointSizeF(0.9 * font.pointSizeF());
  label->setFont(font);
  return label;
}

}  // namespace

StepRow::StepRow(const QString& title, bool sub_step, QWidget* parent)
    : QWidget(parent),
      sub_step_(sub_step),
      icon_(new QLabel(this)),
      title_(sub_step ? smallLabel(this) : new QLabel(this)),
      time_(smallLabel(this)),
      key_(smallLabel(this)),
      bar_(new QProgressBar(this)) {
  constexpr int kIndent_px = 22, kBar_px = 4;
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(sub_step ? kIndent_px : 0, 0, 0, 0);
  grid->setHorizontalSpacing(6);
  grid->setVerticalSpacing(1);
  grid->setColumnStretch(1, 1);
  grid->addWidget(icon_, 0, 0);
  grid->addWidget(title_, 0, 1);
  grid->addWidget(time_, 0, 2);
  grid->addWidget(key_, 1, 1, 1, 2);
  grid->addWidget(bar_, 2, 1, 1, 2);
  title_->setText(title);
  bar_->setRange(0, 1000);
  bar_->setTextVisible(false);
  bar_->setFixedHeight(kBar_px);
  key_->setWordWrap(true);
  key_->hide();
  showState();
}

void StepRow::setState(StepState state) {
  state_ = state;
  showState();
}

void StepRow::showState() {
  const int size = sub_step_ ? 13 : 17;
  icon_->setPixmap(stateIcon(state_).pixmap(QSize(size, size), devicePixelRatioF()));
  bar_->setVisible(state_ == StepState::Running && !sub_step_);
  setAccessibleName(text());
  setToolTip(text());
}

void StepRow::setFraction(double fraction) {
  bar_->setValue(static_cast<int>(1000.0 * fraction));
}

void StepRow::setTime(double time_s) {
  time_->setText(time_s < 0.0 ? QString() : tr("%1 s").arg(time_s, 0, 'f', time_s < 10.0 ? 2 : 1));
}

void StepRow::setKeyNumber(const QString& text, const QString& in_full) {
  const QString full = in_full.isEmpty() ? text : in_full;
  if (text == key_->text() && full == key_in_full_) return;
  key_in_full_ = full;
  key_->setVisible(!text.isEmpty());
  key_->setText(text);
  showState();
}

QString StepRow::text() const {
  QString text = title_->text() + ": " + stateWord(state_);
  if (!time_->text().isEmpty()) text += ", " + time_->text();
  if (!key_in_full_.isEmpty()) text += ", " + key_in_full_;
  return text;
}

void StepRow::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) showState();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
