// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/repeat_screen.h"

#include "ui/screens/assessment/empty_hint.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/repeat_table.h"
#include "ui/screens/assessment/verdict_line.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/screens/check_words.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QStackedWidget>
#include <QTabBar>
#include <QTabWidget>
#include <QVBoxLayout>

#include <algorithm>

namespace evical::ui {
namespace {

constexpr int kFewest = 2;

QPushButton* repeatButton(const char* object_name, const char* icon_name, const QString& text,
                          const QString& tip, QWidget* parent) {
  auto* const made = new QPushButton(icon(icon_name), text, parent);
  made->setObjectName(object_name);
  made->setToolTip(tip);
  return made;
}

QString repeatTitleOf(RepeatVerdict verdict) {
  switch (verdict) {
    case RepeatVerdict::Agree:
      return QObject::tr("They agree");
    case RepeatVerdict::Disagree:
      return QObject::tr("They do not agree");
    case RepeatVerdict::Failed:
      break;
  }
  return QObject::tr("Nothing to compare");
}

VerdictTone toneOf(RepeatVerdict verdict) {
  if (verdict == RepeatVerdict::Agree) return VerdictTone::Good;
  return verdict == RepeatVerdict::Disagree ? VerdictTone::Doubtful : VerdictTone::Bad;
}

QComboBox* makeChoice(const char* object_name, const QString& name, QWidget* parent) {
  auto* const choice = new QComboBox(parent);
  choice->setObjectName(object_name);
  choice->setAccessibleName(name);
  choice->setToolTip(QObject::tr("A recording, or the solution of all together"));
  choice->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  return choice;
}

}  // namespace

RepeatScreen::RepeatScreen(QWidget* parent)
    : QWidget(parent),
      files_(new FileList(
          "recordings", tr("Recordings and sessions of one rig"),
          tr("Sessions or recordings of the same rig before the same board. Recordings have the\n"
             "sensors and the board of the session that is open, else of the first in the list"),
          this)),
      add_open_(repeatButton("add_open", "add", tr("Add the open one"), tr("Add what is open in this window"),
                             this)),
      stack_(new QStackedWidget(this)),
      verdict_(new VerdictLine("repeat", this)),
      ratio_(selectableLabel("hint", {}, this)),
      first_(makeChoice("first_of_pair", tr("Compare"), this)),
      second_(makeChoice("second_of_pair", tr("with"), this)),
      numbers_(new RepeatTable(this)),
      recordings_(new RepeatedList(this)),
      notes_(new QListWidget(this)),
      open_result_(repeatButton(
          "open_recording_result", "result", tr("Show on all pages"),
          tr("Open the chosen recording's result, or that of all together where none is"), this)) {
  files_->insertButton(add_open_);
  connect(add_open_, &QPushButton::clicked, this, [this] { files_->add({open_file_}); });
  connect(files_, &FileList::changed, this, &RepeatScreen::offer);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(10);
  layout->addWidget(makeForm());
  stack_->addWidget(makeEmpty());
  stack_->addWidget(makeContent());
  layout->addWidget(stack_, 1);
  setRepeat({});
  offer();
}

QWidget* RepeatScreen::makeForm() {
  auto* const card = new QFrame(this);
  card->setProperty("card", "true");
  auto* const grid = new QGridLayout;
  folder_ = new PathRow("repeat_folder", tr("&Results go to"),
                        tr("A folder: the results of each recording and of all together, a report, tables"),
                        *grid, card);
  grid->setColumnStretch(1, 1);
  work_ = new WorkBar("repeat", "calibrate", tr("Calibrate all"),
                      tr("Calibrate each recording, then all together, and compare them"), card);
  QPushButton* const report = repeatButton("repeat_report", "report", tr("Open report"),
                                           tr("A page with plots, in the browser"), card);
  QPushButton* const place = repeatButton("repeat_open_folder", "folder", tr("Open folder"),
                                          tr("Show the files in the desktop's file manager"), card);
  for (QPushButton* const each : {report, place}) work_->addButton(each);
  connect(report, &QPushButton::clicked, this, &RepeatScreen::reportRequested);
  connect(place, &QPushButton::clicked, this, &RepeatScreen::openFolderRequested);
  auto* const layout = new QVBoxLayout(card);
  layout->setContentsMargins(14, 10, 14, 10);
  layout->addWidget(selectableLabel("heading", tr("Several recordings of one rig"), card));
  layout->addWidget(files_);
  layout->addLayout(grid);
  layout->addWidget(work_);
  connect(folder_, &PathRow::changed, this, &RepeatScreen::offer);
  connect(work_, &WorkBar::startRequested, this, &RepeatScreen::repeatRequested);
  connect(work_, &WorkBar::cancelRequested, this, &RepeatScreen::cancelRequested);
  return card;
}

QWidget* RepeatScreen::makeEmpty() {
  return emptyHint(
      tr("Each recording is calibrated alone, then all in one solution. The scatter between recordings "
         "shows whether the stated uncertainties are realistic. A recording that does not fit the others is "
         "named, with what is different in it."),
      this);
}

QWidget* RepeatScreen::makeNumbers() {
  auto* const page = new QWidget(this);
  auto* const what = new QLabel(tr("C&ompare"), page);
  what->setBuddy(first_);
  auto* const with = new QLabel(tr("&with"), page);
  with->setBuddy(second_);
  connect(first_, &QComboBox::activated, this, &RepeatScreen::comparePair);
  connect(second_, &QComboBox::activated, this, &RepeatScreen::comparePair);
  auto* const row = new QHBoxLayout;
  for (QWidget* const widget : {static_cast<QWidget*>(what), static_cast<QWidget*>(first_),
                                static_cast<QWidget*>(with), static_cast<QWidget*>(second_)})
    row->addWidget(widget);
  row->addStretch(1);
  auto* const layout = new QVBoxLayout(page);
  layout->setContentsMargins(0, 6, 0, 0);
  layout->addLayout(row);
  layout->addWidget(numbers_, 1);
  return page;
}

QWidget* RepeatScreen::makeRecordings() {
  auto* const page = new QWidget(this);
  connect(open_result_, &QPushButton::clicked, this, [this] {
    const auto chosen = recordings_->chosen();
    emit openResultRequested(chosen ? static_cast<int>(*chosen) : -1);
  });
  connect(recordings_, &QTreeWidget::itemSelectionChanged, this, &RepeatScreen::offer);
  auto* const row = new QHBoxLayout;
  row->addWidget(open_result_);
  row->addStretch();
  auto* const layout = new QVBoxLayout(page);
  layout->setContentsMargins(0, 6, 0, 0);
  layout->addWidget(recordings_, 1);
  layout->addLayout(row);
  return page;
}

QWidget* RepeatScreen::makeContent() {
  auto* const content = new QWidget(this);
  verdict_->addLine(ratio_);
  notes_->setAccessibleName(tr("Notes"));
  notes_->setWordWrap(true);
  notes_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* const tabs = new QTabWidget(content);
  tabs->setObjectName("repeat_tabs");
  tabs->setDocumentMode(true);
  tabs->tabBar()->setDrawBase(false);
  tabs->addTab(makeNumbers(), tr("Numbers"));
  tabs->addTab(makeRecordings(), tr("Recordings"));
  tabs->addTab(notes_, tr("Notes"));
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(verdict_);
  layout->addWidget(tabs, 1);
  return content;
}

void RepeatScreen::setOpenFile(const QString& file) {
  open_file_ = file;
  offer();
}

void RepeatScreen::offer() {
  const QStringList all = files_->files();
  add_open_->setEnabled(!open_file_.isEmpty() && !all.contains(open_file_));
  // One session may list several recordings.
  const bool enough =
      all.size() >= kFewest || (all.size() == 1 && (all[0].endsWith(".yaml") || all[0].endsWith(".yml")));
  work_->setHindrance(!enough                     ? tr("Add at least two recordings or sessions")
                      : folder_->path().isEmpty() ? tr("Say where the results go")
                                                  : QString());
  const auto chosen = recordings_->chosen();
  open_result_->setEnabled(repeat_ &&
                           (chosen ? repeat_->recordings.at(*chosen).outcome != RepeatOutcome::Failed
                                   : repeat_->verdict != RepeatVerdict::Failed));
}

void RepeatScreen::setRepeat(std::optional<Repeatability> repeat) {
  repeat_ = std::move(repeat);
  stack_->setCurrentIndex(repeat_ ? 1 : 0);
  for (const char* const name : {"repeat_report", "repeat_open_folder"})
    work_->findChild<QPushButton*>(name)->setVisible(repeat_.has_value());
  if (!repeat_) return;
  showVerdict();
  numbers_->setRepeat(*repeat_);
  recordings_->setRecordings(repeat_->recordings);
  notes_->clear();
  for (const std::string& note : repeat_->notes) notes_->addItem(sentence(QString::fromStdString(note)));
  if (!repeat_->own_values_of.empty())
    notes_->addItem(
        tr("Biases, gravity and time offsets are each recording's own: the solution of all together has "
           "those of %1.")
            .arg(QString::fromStdString(repeat_->own_values_of)));
  offerPairs();
  offer();
}

void RepeatScreen::showVerdict() {
  verdict_->setVerdict(toneOf(repeat_->verdict), repeatTitleOf(repeat_->verdict),
                       sentence(QString::fromStdString(repeat_->reason)));
  ratio_->setVisible(repeat_->rms_ratio > 0.0);
  ratio_->setText(
      tr("Spread against what the sigmas promise: %1 RMS over all numbers (near 1: the sigmas are "
         "honest); took %2 s.")
          .arg(repeat_->rms_ratio, 0, 'f', 2)
          .arg(repeat_->took_s, 0, 'f', 1));
}

void RepeatScreen::offerPairs() {
  for (QComboBox* const choice : {first_, second_}) {
    choice->clear();
    choice->addItem(tr("nothing"));
    for (const std::string& column : repeat_->columns)
      choice->addItem(QString::fromStdString(column), choice->count() - 1);
    if (repeat_->verdict != RepeatVerdict::Failed) choice->addItem(tr("all together"), -1);
  }
  comparePair();
}

void RepeatScreen::comparePair() {
  const QVariant first = first_->currentData(), second = second_->currentData();
  if (!first.isValid() || !second.isValid() || first == second) return numbers_->comparePair({});
  const auto column = [](const QVariant& chosen) {
    return chosen.toInt() < 0 ? kAllTogether : static_cast<std::size_t>(chosen.toInt());
  };
  numbers_->comparePair(
      RepeatTable::Pair{column(first), column(second), first_->currentText(), second_->currentText()});
}

}  // namespace evical::ui
