// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/assessment_screen.h"

#include "ui/screens/assessment/work_bar.h"

#include "core/report/assessment_report.h"
#include "ui/screens/verdict_labels.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QGridLayout>
#include <QListWidget>
#include <QPushButton>
#include <QStackedWidget>
#include <QTabBar>
#include <QTabWidget>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

VerdictTone toneOf(Verdict verdict) {
  if (verdict == Verdict::Unchanged) return VerdictTone::Good;
  return verdict == Verdict::Changed ? VerdictTone::Bad : VerdictTone::Doubtful;
}

}  // namespace

AssessmentScreen::AssessmentScreen(Words words, QWidget* parent)
    : QWidget(parent),
      words_(std::move(words)),
      form_(new QVBoxLayout),
      grid_(new QGridLayout),
      stack_(new QStackedWidget(this)),
      verdict_(new VerdictLine(words_.name, this)),
      notes_(new QListWidget(this)) {
  auto* const card = new QFrame(this);
  card->setProperty("card", "true");
  auto* const in_card = new QVBoxLayout(card);
  in_card->setContentsMargins(14, 10, 14, 10);
  in_card->addWidget(selectableLabel("heading", words_.heading, card));
  in_card->addLayout(form_);
  grid_->setColumnStretch(1, 1);
  notes_->setObjectName(words_.name + "_notes");
  notes_->setAccessibleName(tr("Advice and notes"));
  notes_->setWordWrap(true);
  notes_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  stack_->addWidget(emptyHint(words_.hint, this));
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(10);
  layout->addWidget(card);
  layout->addWidget(stack_, 1);
}

void AssessmentScreen::addSaveButton(const QString& tip) {
  auto* const save = new QPushButton(icon("export"), tr("Save..."), this);
  save->setObjectName("save_" + words_.name);
  save->setToolTip(tip);
  connect(save, &QPushButton::clicked, this, &AssessmentScreen::saveRequested);
  addResultButton(save);
}

void AssessmentScreen::addResultButton(QPushButton* button) {
  button->setVisible(false);
  result_buttons_.push_back(button);
}

QTabWidget* AssessmentScreen::makeTabs() {
  auto* const tabs = new QTabWidget(this);
  tabs->setObjectName(words_.name + "_tabs");
  tabs->setDocumentMode(true);
  tabs->tabBar()->setDrawBase(false);
  return tabs;
}

void AssessmentScreen::setContent(QWidget* content) {
  work_ = new WorkBar(words_.name, words_.icon_name, words_.start, words_.tip, this);
  for (QPushButton* const button : result_buttons_) work_->addButton(button);
  connect(work_, &WorkBar::startRequested, this, &AssessmentScreen::startRequested);
  connect(work_, &WorkBar::cancelRequested, this, &AssessmentScreen::cancelRequested);
  form_->addWidget(work_);
  auto* const found = new QWidget(this);
  auto* const layout = new QVBoxLayout(found);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(verdict_);
  layout->addWidget(content, 1);
  stack_->addWidget(found);
}

void AssessmentScreen::showAssessment(const Assessment& assessment, const QStringList& more,
                                      const QString& verdict) {
  const auto text = [](const std::string& of_core) { return sentence(QString::fromStdString(of_core)); };
  for (QPushButton* const button : result_buttons_) button->setVisible(true);
  stack_->setCurrentIndex(1);
  const bool says_reason = verdict == QString::fromStdString(assessment.reason);
  QString title = verdict.isEmpty() ? verdictWords(assessment.verdict) : verdict;
  title[0] = title[0].toUpper();
  verdict_->setVerdict(toneOf(assessment.verdict), title, says_reason ? QString() : text(assessment.reason));
  lines_.clear();
  for (const std::string& advice : assessment.advice) lines_.emplace_back("right", text(advice));
  for (const std::string& note : assessment.notes) lines_.emplace_back("info", text(note));
  for (const QString& note : more) lines_.emplace_back("info", note);
  lines_.emplace_back("info",
                      tr("Probability that an unchanged quantity is called changed: at most %1 in 1000.")
                          .arg(1e3 * assessment.false_alarms, 0, 'g', 2));
  fillNotes();
}

void AssessmentScreen::fillNotes() {
  notes_->clear();
  for (const auto& [mark, text] : lines_) notes_->addItem(new QListWidgetItem(icon(mark), text));
}

void AssessmentScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fillNotes();
  QWidget::changeEvent(event);
}

QWidget* emptyHint(const QString& text, QWidget* parent) {
  constexpr int kText_px = 560;
  auto* const empty = new QWidget(parent);
  QLabel* const words = selectableLabel("hint", text, empty);
  words->setMaximumWidth(kText_px);
  auto* const row = new QHBoxLayout;
  row->addStretch();
  row->addWidget(words, 1);
  row->addStretch();
  auto* const layout = new QVBoxLayout(empty);
  layout->addStretch(1);
  layout->addLayout(row);
  layout->addStretch(2);
  return empty;
}

}  // namespace evical::ui

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
