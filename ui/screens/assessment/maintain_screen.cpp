// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/maintain_screen.h"

#include "core/base/error.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/finding_table.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/work_bar.h"

#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QTabWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <optional>
#include <string>

namespace evical::ui {
namespace {

// Automatic (units of the logs), then each of `words`.
template <class Words>
QComboBox* unitBox(const char* object_name, const QString& title, const Words& words, QWidget* parent) {
  auto* const box = new QComboBox(parent);
  box->setObjectName(object_name);
  box->setAccessibleName(title);
  box->setToolTip(QObject::tr("Unit of the logs, if they do not state it or state it wrongly"));
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
    : AssessmentScreen(
          {"maintain", "check", tr("Is the calibration of the IMUs still good?"), tr("Check"),
           tr("Compare the logs with the old result, and follow the IMUs over time"),
           tr("No board is needed. Hold the rig still in several orientations to determine the biases and "
              "scales of each accelerometer. Turn several IMUs together to determine how they are mounted "
              "relative to each other, and whether one has moved. A trajectory from another system checks "
              "the accelerometer of the reference IMU without stops. Set the limits of a change under "
              "Parameters, Maintain.")},
          parent),
      logs_(new FileList(
          "logs", tr("Logs of the IMUs"),
          tr("Recordings with IMUs, in any supported format. Several recordings contain different IMUs,\n"
             "or follow each other"),
          this)),
      result_(new OldResultRow("maintained_result", grid(), this)),
      trajectory_(new PathRow(
          "maintain_trajectory", tr("Tra&jectory"),
          tr("Optional: poses of the reference IMU from another system, in the format of a calibration\n"
             "(trajectory.csv) or in TUM's format"),
          grid(), this)),
      acceleration_unit_(
          unitBox("acceleration_unit", tr("Unit of specific forces"), kAccelerationUnits, this)),
      rate_unit_(unitBox("angular_rate_unit", tr("Unit of angular rates"), kAngularRateUnits, this)),
      streams_(new QLineEdit(this)),
      steps_(new StepTable(this)),
      table_(new FindingTable(this)) {
  trajectory_->setPlaceholder(tr("none"));
  form().addWidget(logs_);
  form().addLayout(&grid());
  form().addLayout(makeUnits());
  addSaveButton(tr("Write maintenance.yaml, tables over time and the report to a folder"));
  setContent(makeContent(charts));
  connect(result_, &PathRow::changed, this, &MaintainScreen::offer);
  connect(logs_, &FileList::changed, this, &MaintainScreen::offer);
  offer();
}

QLayout* MaintainScreen::makeUnits() {
  streams_->setObjectName("streams");
  streams_->setAccessibleName(tr("Streams"));
  streams_->setPlaceholderText(tr("by name"));
  streams_->setToolTip(
      tr("Stream or log of each IMU of the old result, if their names differ:\n"
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

QWidget* MaintainScreen::makeContent(QWidget* charts) {
  auto* const changes = new QWidget(this);
  auto* const tables = new QVBoxLayout(changes);
  tables->setContentsMargins(0, 6, 0, 0);
  tables->addWidget(steps_);
  tables->addWidget(table_, 1);
  QTabWidget* const tabs = makeTabs();
  tabs->addTab(changes, tr("Changes"));
  tabs->addTab(charts, tr("Over time"));
  tabs->addTab(notes(), tr("Notes"));
  return tabs;
}

ImuLogSettings MaintainScreen::settings() const {
  ImuLogSettings settings;
  settings.acceleration_unit = unitOf<AccelerationUnit>(*acceleration_unit_);
  settings.angular_rate_unit = unitOf<AngularRateUnit>(*rate_unit_);
  for (const QString& pair : streams_->text().split(',', Qt::SkipEmptyParts)) {
    const QString name = pair.section('=', 0, 0).trimmed(), stream = pair.section('=', 1).trimmed();
    if (name.isEmpty() || stream.isEmpty())
      throw badInput(
          "Streams", "\"" + pair.trimmed().toStdString() + "\" is not NAME=STREAM",
          "Enter the IMU's name in the old result, =, and its stream or log; or leave the field empty");
    settings.streams[name.toStdString()] = stream.toStdString();
  }
  return settings;
}

void MaintainScreen::setMaintenance(const Maintenance& maintenance) {
  QStringList more;
  for (const MaintainedImu& imu : maintenance.imus) {
    more << tr("%1: stream %2, %3 Hz, from %4 s to %5 s; stops: %6.")
                .arg(QString::fromStdString(imu.name), QString::fromStdString(imu.stream))
                .arg(imu.rate_hz, 0, 'f', 1)
                .arg(imu.from_s, 0, 'f', 1)
                .arg(imu.to_s, 0, 'f', 1)
                .arg(imu.stops.size());
    if (!imu.weakest.empty())
      more << tr("Quantity that the stops of %1 determine least: %2.")
                  .arg(QString::fromStdString(imu.name), QString::fromStdString(imu.weakest));
  }
  const auto changed = [](const Finding& finding) { return finding.changed; };
  const bool during_logs =
      maintenance.verdict == Verdict::Changed && std::ranges::none_of(maintenance.findings, changed);
  showAssessment(maintenance, more, during_logs ? tr("Changed during the logs") : QString());
  steps_->setSteps(maintenance.steps);
  table_->setFindings(maintenance.findings);
}

void MaintainScreen::offer() {
  work().setHindrance(logs_->files().isEmpty()    ? tr("Add the logs of the IMUs")
                      : result_->path().isEmpty() ? tr("Choose the old result")
                                                  : QString());
}

}  // namespace evical::ui
