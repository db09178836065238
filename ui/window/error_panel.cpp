// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/error_panel.h"

#include "ui/forms/repair_button.h"
#include "ui/screens/verdict_labels.h"
#include "ui/theme/theme.h"

#include <QDesktopServices>
#include <QDir>
#include <QEvent>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <QUrl>

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

namespace evical::ui {
namespace {

QLabel* noticeLabel(QWidget* parent) {
  auto* const label = new QLabel(parent);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  return label;
}

}  // namespace

ExportNotice::ExportNotice(QWidget* parent)
    : QFrame(parent),
      icon_(new QLabel(this)),
      title_(noticeLabel(this)),
      place_(noticeLabel(this)),
      details_(noticeLabel(this)) {
  setProperty("card", "true");
  setAccessibleName(tr("Export"));
  title_->setProperty("role", "heading");
  auto* const open = new QPushButton(icon("folder"), tr("Open folder"), this);
  open->setObjectName("open_folder");
  open->setToolTip(tr("Show the files in the desktop's file manager"));
  connect(open, &QPushButton::clicked, this, &ExportNotice::openFolder);
  auto* const close = new QToolButton(this);
  close->setIcon(icon("close"));
  close->setAccessibleName(tr("Dismiss"));
  close->setToolTip(tr("Dismiss (Esc)"));
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(14, 10, 8, 10);
  grid->setColumnStretch(1, 1);
  grid->setHorizontalSpacing(12);
  grid->addWidget(icon_, 0, 0, 2, 1, Qt::AlignTop);
  grid->addWidget(title_, 0, 1);
  grid->addWidget(place_, 1, 1);
  grid->addWidget(details_, 2, 1);
  grid->addWidget(open, 0, 2, 2, 1, Qt::AlignTop);
  grid->addWidget(close, 0, 3, 2, 1, Qt::AlignTop);
  setFocusPolicy(Qt::StrongFocus);
  hide();
}

void ExportNotice::showOutcome(const ExportOutcome& outcome) {
  folder_ = outcome.folder;
  whole_ = outcome.refused.isEmpty() && outcome.differing.isEmpty();
  title_->setText(!outcome.title.isEmpty()    ? outcome.title
                  : outcome.refused.isEmpty() ? tr("The result was exported")
                  : outcome.programs.isEmpty()
                      ? tr("The result was written, but not exported for any program")
                      : tr("The result was exported, but not for all programs"));
  place_->setText(tr("The files are in %1").arg(QDir::toNativeSeparators(folder_)));
  QStringList lines;
  if (!outcome.programs.isEmpty()) lines << tr("Written for: %1.").arg(outcome.programs.join(", "));
  if (outcome.checked && outcome.differing.isEmpty() && !outcome.programs.isEmpty())
    lines << tr("Read back as those programs do: all values agree with the result.");
  lines << outcome.differing << outcome.refused;
  details_->setText(lines.join('\n'));
  details_->setVisible(!lines.isEmpty());
  setAccessibleName(text());
  showIcon();
  show();
}

QString ExportNotice::text() const {
  return QStringList{title_->text(), place_->text(), details_->text()}.join('\n');
}

void ExportNotice::openFolder() {
  if (!QDesktopServices::openUrl(QUrl::fromLocalFile(folder_)))
    place_->setText(tr("No program on this computer shows folders. The files are in %1")
                        .arg(QDir::toNativeSeparators(folder_)));
}

void ExportNotice::showIcon() {
  const QIcon sign = whole_ ? icon("done", theme().good) : icon("warning", theme().warning);
  icon_->setPixmap(sign.pixmap(QSize(26, 26), devicePixelRatioF()));
}

void ExportNotice::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) showIcon();
  QFrame::changeEvent(event);
}

void ExportNotice::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return hide();
  QFrame::keyPressEvent(event);
}

}  // namespace evical::ui
