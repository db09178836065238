// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/result_check_screen.h"

#include "ui/screens/assessment/check_table.h"
#include "ui/screens/assessment/empty_hint.h"
#include "ui/screens/assessment/old_result_row.h"
#include "ui/screens/assessment/verdict_line.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/screens/check_words.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QGridLayout>
#include <QListWidget>
#include <QPushButton>
#include <QStackedWidget>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

QString titleOf(CheckVerdict verdict) {
  switch (verdict) {
    case CheckVerdict::StillGood:
      return QObject::tr("Still good");
    case CheckVerdict::Changed:
      return QObject::tr("Changed");
    case CheckVerdict::CannotTell:
      break;
  }
  return QObject::tr("Cannot tell");
}

VerdictTone toneOf(CheckVerdict verdict) {
  if (verdict == CheckVerdict::StillGood) return VerdictTone::Good;
  return verdict == CheckVerdict::Changed ? VerdictTone::Bad : VerdictTone::Doubtful;
}

}  // namespace

ResultCheckScreen::ResultCheckScreen(QWidget* parent)
    : QWidget(parent),
      stack_(new QStackedWidget(this)),
      verdict_(new VerdictLine("check", this)),
      table_(new CheckTable(this)),
      notes_(new QListWidget(this)),
      save_(new QPushButton(icon("export"), tr("Save..."), this)) {
  save_->setObjectName("save_check");
  save_->setToolTip(tr("Write check.yaml and the report to a folder"));
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(10);
  layout->addWidget(makeForm());
  stack_->addWidget(makeEmpty());
  stack_->addWidget(makeContent());
  layout->addWidget(stack_, 1);
  connect(save_, &QPushButton::clicked, this, &ResultCheckScreen::saveRequested);
  setCheck({});
  offer();
}

QWidget* ResultCheckScreen::makeForm() {
  auto* const card = new QFrame(this);
  card->setProperty("card", "true");
  auto* const grid = new QGridLayout;
  result_ = new OldResultRow("old_result", *grid, card);
  recording_ =
      new PathRow("new_recording", tr("&New recording"),
                  tr("Some ten seconds before the same board, or a session of them. Board and sensors of a\n"
                     "recording are those that are kept beside the old result."),
                  *grid, card);
  grid->setColumnStretch(1, 1);
  work_ = new WorkBar("check_result", "check", tr("Check"),
                      tr("Calibrate the new recording, and test each quantity's change"), card);
  work_->addButton(save_);
  auto* const layout = new QVBoxLayout(card);
  layout->setContentsMargins(14, 10, 14, 10);
  layout->addWidget(selectableLabel("heading", tr("Is an old calibration still good?"), card));
  layout->addLayout(grid);
  layout->addWidget(work_);
  connect(result_, &PathRow::changed, this, &ResultCheckScreen::offer);
  connect(recording_, &PathRow::changed, this, &ResultCheckScreen::offer);
  connect(work_, &WorkBar::startRequested, this, &ResultCheckScreen::checkRequested);
  connect(work_, &WorkBar::cancelRequested, this, &ResultCheckScreen::cancelRequested);
  return card;
}

QWidget* ResultCheckScreen::makeEmpty() {
  return emptyHint(tr("Move the rig before the board for some ten seconds, as for a calibration, and "
                      "choose that recording above. It is calibrated anew and held against the old "
                      "result. Each quantity is reported as unchanged, changed, or undecided (the "
                      "recording is too weak to tell)."),
                   this);
}

QWidget* ResultCheckScreen::makeContent() {
  constexpr int kNotes_px = 110;
  auto* const content = new QWidget(this);
  notes_->setObjectName("check_notes");
  notes_->setAccessibleName(tr("What to do, and notes"));
  notes_->setWordWrap(true);
  notes_->setMaximumHeight(kNotes_px);
  notes_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(verdict_);
  layout->addWidget(table_, 1);
  layout->addWidget(notes_);
  return content;
}

void ResultCheckScreen::setCheck(std::optional<CalibrationCheck> check) {
  check_ = std::move(check);
  save_->setVisible(check_.has_value());
  stack_->setCurrentIndex(check_ ? 1 : 0);
  if (!check_) return;
  verdict_->setVerdict(toneOf(check_->verdict), titleOf(check_->verdict),
                       sentence(QString::fromStdString(check_->reason)));
  showNotes();
  table_->setQuantities(check_->quantities);
  table_->setVisible(!check_->quantities.empty());
}

void ResultCheckScreen::offer() {
  work_->setHindrance(result_->path().isEmpty()      ? tr("Choose the old result")
                      : recording_->path().isEmpty() ? tr("Choose the new recording")
                                                     : QString());
}

void ResultCheckScreen::showNotes() {
  notes_->clear();
  for (const std::string& advice : check_->advice)
    notes_->addItem(new QListWidgetItem(icon("right"), sentence(QString::fromStdString(advice))));
  for (const std::string& note : check_->notes)
    notes_->addItem(new QListWidgetItem(icon("info"), sentence(QString::fromStdString(note))));
  notes_->addItem(new QListWidgetItem(
      icon("info"), tr("A calibration that has not changed is called changed in %1 of 1000 checks.")
                        .arg(1e3 * check_->false_alarms, 0, 'g', 2)));
}

void ResultCheckScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange && check_) showNotes();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
