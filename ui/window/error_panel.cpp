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

NoticeCard::NoticeCard(const QString& name, QWidget* parent)
    : QFrame(parent),
      grid_(new QGridLayout(this)),
      title_(new QLabel(this)),
      body_(new QLabel(this)),
      details_(new QLabel(this)),
      icon_(new QLabel(this)) {
  setAccessibleName(name);
  setFocusPolicy(Qt::StrongFocus);
  title_->setProperty("role", "heading");
  auto* const close = new QToolButton(this);
  close->setIcon(icon("close"));
  close->setAccessibleName(tr("Dismiss"));
  close->setToolTip(tr("Dismiss (Esc)"));
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  grid_->setContentsMargins(14, 10, 8, 10);
  grid_->setColumnStretch(1, 1);
  grid_->setHorizontalSpacing(12);
  grid_->addWidget(icon_, 0, 0, 2, 1, Qt::AlignTop);
  grid_->addWidget(close, 0, 3, 2, 1, Qt::AlignTop);
  for (int row = 0; QLabel* const label : {title_, body_, details_}) {
    label->setWordWrap(true);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    grid_->addWidget(label, row++, 1);
  }
  hide();
}

void NoticeCard::present() {
  details_->setVisible(!details_->text().isEmpty());
  setAccessibleName(text());
  showIcon();
  show();
}

QString NoticeCard::text() const {
  return QStringList{title_->text(), body_->text(), details_->text()}.join('\n');
}

void NoticeCard::showIcon() {
  icon_->setPixmap(sign().pixmap(QSize(26, 26), devicePixelRatioF()));
}

void NoticeCard::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange && isVisible()) showIcon();
  QFrame::changeEvent(event);
}

void NoticeCard::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return hide();
  QFrame::keyPressEvent(event);
}

ErrorPanel::ErrorPanel(QWidget* parent) : NoticeCard(tr("Error"), parent), repair_(new RepairButton(this)) {
  setProperty("card", "bad");
  grid_->addWidget(repair_, 3, 1, Qt::AlignLeft);
  connect(repair_, &RepairButton::repairRequested, this, &ErrorPanel::repairRequested);
}

void ErrorPanel::showError(const QString& what_was_tried, const JobError& error) {
  title_->setText(what_was_tried);
  body_->setText(sentence(error.place.isEmpty() ? error.problem : error.place + ": " + error.problem));
  details_->setText(error.advice.isEmpty() ? QString() : tr("What to do: %1").arg(sentence(error.advice)));
  repair_->setRepair(error.repair);
  present();
}

QIcon ErrorPanel::sign() const {
  return icon("error", theme().bad);
}

ExportNotice::ExportNotice(QWidget* parent) : NoticeCard(tr("Export"), parent) {
  setProperty("card", "true");
  auto* const open = new QPushButton(icon("folder"), tr("Open folder"), this);
  open->setObjectName("open_folder");
  open->setToolTip(tr("Show the files in the desktop's file manager"));
  connect(open, &QPushButton::clicked, this, &ExportNotice::openFolder);
  grid_->addWidget(open, 0, 2, 2, 1, Qt::AlignTop);
}

void ExportNotice::showOutcome(const ExportOutcome& outcome) {
  folder_ = outcome.folder;
  whole_ = outcome.refused.isEmpty() && outcome.differing.isEmpty();
  title_->setText(!outcome.title.isEmpty()    ? outcome.title
                  : outcome.refused.isEmpty() ? tr("The result was exported")
                  : outcome.programs.isEmpty()
                      ? tr("The result was written, but not exported for any program")
                      : tr("The result was exported, but not for all programs"));
  body_->setText(tr("The files are in %1").arg(QDir::toNativeSeparators(folder_)));
  QStringList lines;
  if (!outcome.programs.isEmpty()) lines << tr("Written for: %1.").arg(outcome.programs.join(", "));
  if (outcome.checked && outcome.differing.isEmpty() && !outcome.programs.isEmpty())
    lines << tr("Read back as those programs do: all values agree with the result.");
  lines << outcome.differing << outcome.refused;
  details_->setText(lines.join('\n'));
  present();
}

void ExportNotice::openFolder() {
  if (!QDesktopServices::openUrl(QUrl::fromLocalFile(folder_)))
    body_->setText(tr("No program on this computer shows folders. The files are in %1")
                       .arg(QDir::toNativeSeparators(folder_)));
}

QIcon ExportNotice::sign() const {
  return whole_ ? icon("done", theme().good) : icon("warning", theme().warning);
}

}  // namespace evical::ui
