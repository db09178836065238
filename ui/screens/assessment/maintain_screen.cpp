// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/maintain_screen.h"

#include "core/base/error.h"
#include "core/report/maintenance_report.h"
#include "ui/screens/assessment/empty_hint.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/maintain_table.h"
#include "ui/screens/assessment/old_result_row.h"
#include "ui/screens/assessment/verdict_line.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/screens/check_words.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QEvent>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QStackedWidget>
#include <QTabBar>
#include <QTabWidget>
#include <QVBoxLayout>

#include <string>
#include <utility>

namespace evical::ui {
namespace {

VerdictTone toneOf(MaintenanceVerdict verdict) {
  if (verdict == MaintenanceVerdict::Unchanged) return VerdictTone::Good;
  return verdict == MaintenanceVerdict::Changed ? VerdictTone::Bad : VerdictTone::Doubtful;
}

// What logs say themselves, then each of these.
template <class Words>
QComboBox* unitBox(const char* object_name, const QString& title, const Words& words, QWidget* parent) {
  auto* const box = new QComboBox(parent);
  box->setObjectName(object_name);
  box->setAccessibleName(title);
  box->setToolTip(QObject::tr("Where logs do not say what they are in, or say it wrongly"));
  box->addItem(QObject::tr("automatic"));
  for (const char* const word : words) box->addItem(word);
  return box;
}

template <class Unit>
std::optional<Unit> unitOf(const QComboBox& box) {
  if (box.currentIndex() <= 0) return std::nullopt;
  return static_cast<Unit>(box.currentIndex() - 1);
}

}  // namespace

MaintainScreen::MaintainScreen(QWidget* charts, QWidget* parent)
    : QWidget(parent),
      logs_(new FileList(
          "logs", tr("Logs of the IMUs"),
          tr("Recordings with IMUs, in any format that Evical opens. Several are of several IMUs, or\n"
             "follow each other"),
          this)),
      acceleration_unit_(unitBox("acceleration_unit", tr("Specific forces in"), kAccelerationUnits, this)),
      rate_unit_(unitBox("angular_rate_unit", tr("Angular rates in"), kAngularRateUnits, this)),
      streams_(new QLineEdit(this)),
      stack_(new QStackedWidget(this)),
      verdict_(new VerdictLine("maintain", this)),
      steps_(new StepTable(this)),
      table_(new MaintainTable(this)),
      notes_(new QListWidget(this)),
      save_(new QPushButton(icon("export"), tr("Save..."), this)) {
  save_->setObjectName("save_maintenance");
  save_->setToolTip(tr("Write maintenance.yaml, tables over time and the report to a folder"));
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(10);
  layout->addWidget(makeForm());
  stack_->addWidget(makeEmpty());
  stack_->addWidget(makeContent(charts));
  layout->addWidget(stack_, 1);
  connect(save_, &QPushButton::clicked, this, &MaintainScreen::saveRequested);
  setMaintenance({});
  offer();
}

QLayout* MaintainScreen::makeUnits() {
  streams_->setObjectName("streams");
  streams_->setAccessibleName(tr("Streams"));
  streams_->setPlaceholderText(tr("by their names"));
  streams_->setToolTip(
      tr("Which stream or log is of which IMU of the old result, where names do not tell:\n"
         "NAME=STREAM, separated by commas"));
  auto* const row = new QHBoxLayout;
  const auto add = [&](const QString& title, QWidget* widget, int stretch) {
    auto* const label = new QLabel(title, this);
    label->setBuddy(widget);
    row->addWidget(label);
    row->addWidget(widget, stretch);
  };
  add(tr("&Accelerometer unit"), acceleration_unit_, 0);
  add(tr("Gyroscope u&nit"), rate_unit_, 0);
  add(tr("St&reams"), streams_, 1);
  return row;
}

QWidget* MaintainScreen::makeForm() {
  auto* const card = new QFrame(this);
  card->setProperty("card", "true");
  auto* const grid = new QGridLayout;
  result_ = new OldResultRow("maintained_result", *grid, card);
  trajectory_ = new PathRow(
      "maintain_trajectory", tr("Tra&jectory"),
      tr("If there is one: poses of the reference IMU from elsewhere, as a calibration writes them\n"
         "(trajectory.csv) or in TUM's format"),
      *grid, card);
  trajectory_->setPlaceholder(tr("none"));
  grid->setColumnStretch(1, 1);
  work_ = new WorkBar("maintain", "check", tr("Check"),
                      tr("Compare the logs with the old result, and follow the IMUs over time"), card);
  work_->addButton(save_);
  auto* const layout = new QVBoxLayout(card);
  layout->setContentsMargins(14, 10, 14, 10);
  layout->addWidget(selectableLabel("heading", tr("Are the IMUs still as they were calibrated?"), card));
  layout->addWidget(logs_);
  layout->addLayout(grid);
  layout->addLayout(makeUnits());
  layout->addWidget(work_);
  connect(result_, &PathRow::changed, this, &MaintainScreen::offer);
  connect(logs_, &FileList::changed, this, &MaintainScreen::offer);
  connect(work_, &WorkBar::startRequested, this, &MaintainScreen::maintainRequested);
  connect(work_, &WorkBar::cancelRequested, this, &MaintainScreen::cancelRequested);
  return card;
}

QWidget* MaintainScreen::makeEmpty() {
  return emptyHint(
      tr("No board is needed. Hold the rig still in several orientations to determine the biases and scales "
         "of "
         "each accelerometer. Turn several IMUs together to see how they are mounted relative to each other, "
         "and when one has moved. A trajectory from another system checks the accelerometer of the reference "
         "IMU without stops. Limits for what counts as a change are under Parameters, Maintain."),
      this);
}

QWidget* MaintainScreen::makeContent(QWidget* charts) {
  auto* const content = new QWidget(this);
  notes_->setObjectName("maintain_notes");
  notes_->setAccessibleName(tr("What to do, and notes"));
  notes_->setWordWrap(true);
  notes_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* const changes = new QWidget(content);
  auto* const tables = new QVBoxLayout(changes);
  tables->setContentsMargins(0, 6, 0, 0);
  tables->addWidget(steps_);
  tables->addWidget(table_, 1);
  auto* const tabs = new QTabWidget(content);
  tabs->setObjectName("maintain_tabs");
  tabs->setDocumentMode(true);
  tabs->tabBar()->setDrawBase(false);
  tabs->addTab(changes, tr("Changes"));
  tabs->addTab(charts, tr("Over time"));
  tabs->addTab(notes_, tr("Notes"));
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(verdict_);
  layout->addWidget(tabs, 1);
  return content;
}

ImuLogSettings MaintainScreen::settings() const {
  ImuLogSettings settings;
  settings.acceleration_unit = unitOf<AccelerationUnit>(*acceleration_unit_);
  settings.angular_rate_unit = unitOf<AngularRateUnit>(*rate_unit_);
  for (const QString& pair : streams_->text().split(',', Qt::SkipEmptyParts)) {
    const QString name = pair.section('=', 0, 0).trimmed(), stream = pair.section('=', 1).trimmed();
    if (name.isEmpty() || stream.isEmpty())
      throw badInput("Streams", "\"" + pair.trimmed().toStdString() + "\" is not NAME=STREAM",
                     "Write an IMU's name of the old result, =, and its stream or log; or leave it empty");
    settings.streams[name.toStdString()] = stream.toStdString();
  }
  return settings;
}

void MaintainScreen::setMaintenance(std::optional<Maintenance> maintenance) {
  maintenance_ = std::move(maintenance);
  save_->setVisible(maintenance_.has_value());
  stack_->setCurrentIndex(maintenance_ ? 1 : 0);
  if (!maintenance_) return;
  QString title = verdictWords(maintenance_->verdict);
  title[0] = title[0].toUpper();
  verdict_->setVerdict(toneOf(maintenance_->verdict), title,
                       sentence(QString::fromStdString(maintenance_->reason)));
  steps_->setSteps(maintenance_->steps);
  table_->setQuantities(maintenance_->quantities);
  showNotes();
}

void MaintainScreen::offer() {
  work_->setHindrance(logs_->files().isEmpty()    ? tr("Add the logs of the IMUs")
                      : result_->path().isEmpty() ? tr("Choose the old result")
                                                  : QString());
}

void MaintainScreen::showNotes() {
  notes_->clear();
  const auto add = [this](const char* mark, const QString& text) {
    notes_->addItem(new QListWidgetItem(icon(mark), text));
  };
  for (const std::string& advice : maintenance_->advice)
    add("right", sentence(QString::fromStdString(advice)));
  for (const std::string& note : maintenance_->notes) add("info", sentence(QString::fromStdString(note)));
  for (const MaintainedImu& imu : maintenance_->imus) {
    add("info", tr("%1: stream %2, %3 Hz, from %4 s to %5 s; stops: %6.")
                    .arg(QString::fromStdString(imu.name), QString::fromStdString(imu.stream))
                    .arg(imu.rate_hz, 0, 'f', 1)
                    .arg(imu.from_s, 0, 'f', 1)
                    .arg(imu.to_s, 0, 'f', 1)
                    .arg(imu.stops.size()));
    if (!imu.weakest.empty())
      add("info", tr("Least known from the stops of %1: %2.")
                      .arg(QString::fromStdString(imu.name), QString::fromStdString(imu.weakest)));
  }
  add("info", tr("Logs in which nothing changes have an alarm in %1 of 1000 cases at most.")
                  .arg(1e3 * maintenance_->false_alarms, 0, 'g', 2));
}

void MaintainScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange && maintenance_) showNotes();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
