// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/repeat_screen.h"

#include "ui/screens/assessment/assessment_screen.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/repeat_table.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QTabWidget>
#include <QVBoxLayout>

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

QComboBox* makeChoice(const char* object_name, const QString& name, QWidget* parent) {
  auto* const choice = new QComboBox(parent);
  choice->setObjectName(object_name);
  choice->setAccessibleName(name);
  choice->setToolTip(QObject::tr("A recording, or the joint solution of all"));
  choice->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  return choice;
}

// Not "unchanged": the recordings are compared with each other, not with an old result.
QString agreementText(const Repeatability& repeat) {
  if (repeat.verdict == Verdict::Unchanged) return QString::fromStdString(repeat.reason);
  return repeat.verdict == Verdict::Changed ? QObject::tr("The recordings disagree") : QString();
}

}  // namespace

RepeatScreen::RepeatScreen(QWidget* parent)
    : AssessmentScreen(
          {"repeat", "calibrate", tr("Several recordings of one rig"), tr("Calibrate all"),
           tr("Calibrate each recording, then all together, and compare them"),
           tr("Each recording is calibrated alone, then all in one solution. The scatter between recordings "
              "shows whether the stated uncertainties are realistic. A recording that does not fit the "
              "others is listed with its differences.")},
          parent),
      files_(new FileList(
          "recordings", tr("Recordings and sessions of one rig"),
          tr("Sessions or recordings of the same rig with the same board. For recordings, sensors and board\n"
             "are those of the open session, else of the first one in the list"),
          this)),
      add_open_(repeatButton("add_open", "add", tr("Add the open one"),
                             tr("Add what is open in this program"), this)),
      folder_(new PathRow(
          "repeat_folder", tr("&Results folder"),
          tr("Folder for the results of each recording and of all together, a report, and tables"), grid(),
          this)),
      ratio_(selectableLabel("hint", {}, this)),
      first_(makeChoice("first_of_pair", tr("Compare"), this)),
      second_(makeChoice("second_of_pair", tr("with"), this)),
      numbers_(new RepeatTable(this)),
      recordings_(new RepeatedList(this)),
      open_result_(repeatButton(
          "open_recording_result", "result", tr("Show on all pages"),
          tr("Open the chosen recording's result, or the joint one if no recording is chosen"), this)) {
  addForm();
  verdict().addLine(ratio_);
  QTabWidget* const tabs = makeTabs();
  tabs->addTab(makeNumbers(), tr("Numbers"));
  tabs->addTab(makeRecordings(), tr("Recordings"));
  tabs->addTab(notes(), tr("Notes"));
  setContent(tabs);
  offer();
}

void RepeatScreen::addForm() {
  files_->insertButton(add_open_);
  form().addWidget(files_);
  form().addLayout(&grid());
  QPushButton* const report =
      repeatButton("repeat_report", "report", tr("Open report"), tr("Page with plots, in the browser"), this);
  QPushButton* const place = repeatButton("repeat_open_folder", "folder", tr("Open folder"),
                                          tr("Show the files in the desktop's file manager"), this);
  addResultButton(report);
  addResultButton(place);
  connect(report, &QPushButton::clicked, this, &RepeatScreen::reportRequested);
  connect(place, &QPushButton::clicked, this, &RepeatScreen::openFolderRequested);
  connect(add_open_, &QPushButton::clicked, this, [this] { files_->add({open_file_}); });
  connect(files_, &FileList::changed, this, &RepeatScreen::offer);
  connect(folder_, &PathRow::changed, this, &RepeatScreen::offer);
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

void RepeatScreen::setOpenFile(const QString& file) {
  open_file_ = file;
  offer();
}

void RepeatScreen::offer() {
  const QStringList all = files_->files();
  add_open_->setEnabled(!open_file_.isEmpty() && !all.contains(open_file_));
  // A session may list several recordings.
  const bool enough =
      all.size() >= kFewest || (all.size() == 1 && (all[0].endsWith(".yaml") || all[0].endsWith(".yml")));
  work().setHindrance(!enough                     ? tr("Add at least two recordings or sessions")
                      : folder_->path().isEmpty() ? tr("Choose a folder for the results")
                                                  : QString());
  const auto chosen = recordings_->chosen();
  open_result_->setEnabled(repeat_ &&
                           (chosen ? repeat_->recordings.at(*chosen).outcome != RepeatOutcome::Failed
                                   : repeat_->verdict != Verdict::CannotTell));
}

void RepeatScreen::setRepeat(const Repeatability& repeat) {
  repeat_ = repeat;
  QStringList more;
  if (!repeat.own_values_of.empty())
    more << tr("Biases, gravity and time offsets are separate for each recording: the joint solution lists "
               "those of %1.")
                .arg(QString::fromStdString(repeat.own_values_of));
  showAssessment(repeat, more, agreementText(repeat));
  ratio_->setVisible(repeat.rms_ratio > 0.0);
  ratio_->setText(
      tr("Ratio of the observed scatter to the one expected from the sigmas: %1 RMS over all numbers "
         "(near 1 if the sigmas are realistic). Duration: %2 s.")
          .arg(repeat.rms_ratio, 0, 'f', 2)
          .arg(repeat.took_s, 0, 'f', 1));
  numbers_->setRepeat(repeat);
  recordings_->setRecordings(repeat.recordings);
  offerPairs();
  offer();
}

void RepeatScreen::offerPairs() {
  for (QComboBox* const choice : {first_, second_}) {
    choice->clear();
    choice->addItem(choice == first_ ? tr("one recording") : tr("another one"));
    for (const std::string& column : repeat_->columns)
      choice->addItem(QString::fromStdString(column), choice->count() - 1);
    if (repeat_->verdict != Verdict::CannotTell) choice->addItem(tr("all together"), -1);
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
