// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/error_panel.h"

#include "ui/forms/repair_button.h"
#include "ui/screens/verdict_labels.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QToolButton>

namespace evical::ui {
namespace {

QLabel* errorLabel(QWidget* parent) {
  auto* const label = new QLabel(parent);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

}  // namespace

ErrorPanel::ErrorPanel(QWidget* parent)
    : QFrame(parent),
      icon_(new QLabel(this)),
      title_(errorLabel(this)),
      problem_(errorLabel(this)),
      advice_(errorLabel(this)),
      repair_(new RepairButton(this)) {
  setProperty("card", "bad");
  setAccessibleName(tr("Error"));
  title_->setProperty("role", "heading");
  auto* const close = new QToolButton(this);
  close->setIcon(icon("close"));
  close->setToolTip(tr("Dismiss (Esc)"));
  close->setAccessibleName(tr("Dismiss"));
  connect(close, &QToolButton::clicked, this, &ErrorPanel::dismiss);
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(14, 10, 8, 10);
  grid->setColumnStretch(1, 1);
  grid->setHorizontalSpacing(12);
  grid->addWidget(icon_, 0, 0, 2, 1, Qt::AlignTop);
  grid->addWidget(title_, 0, 1);
  grid->addWidget(problem_, 1, 1);
  grid->addWidget(advice_, 2, 1);
  grid->addWidget(repair_, 3, 1, Qt::AlignLeft);
  connect(repair_, &RepairButton::repairRequested, this, &ErrorPanel::repairRequested);
  grid->addWidget(close, 0, 2, 2, 1, Qt::AlignTop);
  setFocusPolicy(Qt::StrongFocus);
  showIcon();
  hide();
}

void ErrorPanel::showError(const QString& what_was_tried, const JobError& error) {
  title_->setText(what_was_tried);
  problem_->setText(sentence(error.place.isEmpty() ? error.problem : error.place + ": " + error.problem));
  advice_->setText(error.advice.isEmpty() ? QString() : tr("What to do: %1").arg(sentence(error.advice)));
  advice_->setVisible(!error.advice.isEmpty());
  repair_->setRepair(error.repair);
  setAccessibleName(text());
  show();
}

void ErrorPanel::dismiss() {
  hide();
}

QString ErrorPanel::text() const {
  return QStringList{title_->text(), problem_->text(), advice_->text()}.join('\n');
}

void ErrorPanel::showIcon() {
  icon_->setPixmap(icon("error", theme().bad).pixmap(QSize(26, 26), devicePixelRatioF()));
}

void ErrorPanel::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) showIcon();
  QFrame::changeEvent(event);
}

void ErrorPanel::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return dismiss();
  QFrame::keyPressEvent(event);
}

}  // namespace evical::ui
