// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/stage_labels.h"

#include <QCoreApplication>
#include <QStringList>

#include <array>

namespace evical::ui {
namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("stages", text);
}

// Groups the quantities by sensor: "camera: rotation vector, translation".
QString grouped(const std::vector<std::string>& released) {
  const std::array<QString, 3> owners = {"camera", "IMU", "board"};
  std::array<QStringList, 3> of_owner;
  QStringList rest;
  for (const std::string& each : released) {
    const QString words = QString::fromStdString(each);
    bool owned = false;
    for (std::size_t k = 0; k < owners.size() && !owned; ++k) {
      owned = words.startsWith(owners[k] + ' ');
      if (owned) of_owner[k] << words.mid(owners[k].size() + 1);
    }
    if (!owned) rest << words;
  }
  QStringList groups;
  for (std::size_t k = 0; k < owners.size(); ++k)
    if (!of_owner[k].isEmpty()) groups << owners[k] + ' ' + of_owner[k].join(", ");
  if (!rest.isEmpty()) groups << rest.join(", ");
  return groups.join("; ");
}

}  // namespace

std::vector<StageWords> stageWords(const std::vector<IterationRecord>& iterations) {
  std::vector<StageWords> stages;
  int stage = 0;
  for (const IterationRecord& record : iterations) {
    if (record.stage == stage) continue;
    const bool first = stage == 0;
    stage = record.stage;
    const QString freed = grouped(record.released);
    const auto count = static_cast<int>(record.released.size());
    const QString quantities = count == 1 ? tr("1 quantity") : tr("%1 quantities").arg(count);
    if (first)
      stages.push_back({tr("Stage %1: trajectory, %2").arg(stage).arg(quantities),
                        tr("Stage %1: trajectory; %2").arg(stage).arg(freed)});
    else if (count > 0)
      stages.push_back(
          {tr("Stage %1: + %2").arg(stage).arg(quantities), tr("Stage %1: + %2").arg(stage).arg(freed)});
    else
      stages.push_back(
          {tr("Stage %1: new weights").arg(stage),
           tr("Stage %1: the same, weighted by the estimated noise, until convergence").arg(stage)});
  }
  return stages;
}

QString stagesHelp() {
  return tr(
      "The optimiser frees parameters stage by stage. Before each stage it weights the sensors again by the\n"
      "estimated noise and drops outliers: this changes the meaning of the cost, which jumps.\n"
      "Within a stage the cost must decrease.");
}

QString neededHelp() {
  return tr(
      "Shaded: the final value plus and minus one sigma. Dash-dotted: the accuracy that the verdict needs\n"
      "(Parameters, needed accuracy); the lines may be outside the shown range.");
}

}  // namespace evical::ui
