// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/old_result.h"

#include "core/report/result_yaml.h"
#include "ui/screens/assessment/old_result_row.h"
#include "ui/screens/result/runs_panel.h"
#include "ui/window/page_work.h"
#include "ui/window/workbench.h"

#include <QFileDialog>

#include <algorithm>
#include <utility>
#include <vector>

namespace evical::ui {
namespace {

void propose(OldResultRow& row, const Workbench& workbench) {
  std::vector<std::pair<QString, QString>> runs;
  for (const RunSummary& run : workbench.history.runs())
    runs.emplace_back(QString("%1: %2").arg(titleOf(run), statusName(run.status)),
                      QString::fromStdString(run.folder.string()));
  std::reverse(runs.begin(), runs.end());  // newest first
  row.setKeptRuns(runs);
  row.proposePath(QString::fromStdString(workbench.history.folderOf(workbench.document.last().run).string()));
}

}  // namespace

void wireOldResult(OldResultRow& row, QWidget& page, Workbench& workbench) {
  QObject::connect(&row, &OldResultRow::folderRequested, &page, [&row, &page] {
    const QString folder =
        QFileDialog::getExistingDirectory(&page, QObject::tr("Folder of the old result"), lastUsedFolder());
    if (!folder.isEmpty()) row.setPath(folder);
  });
  QObject::connect(&row, &OldResultRow::fileRequested, &page, [&row, &page] {
    const QString file = QFileDialog::getOpenFileName(&page, QObject::tr("Old result"), lastUsedFolder(),
                                                      QObject::tr("Results (*.yaml *.yml);;All files (*)"));
    if (!file.isEmpty()) row.setPath(file);
  });
  const auto suggest = [&row, &workbench] { propose(row, workbench); };
  QObject::connect(&workbench.document, &CalibrationDocument::runsChanged, &row, suggest);
  QObject::connect(&workbench.document, &CalibrationDocument::sessionReplaced, &row, suggest);
  QObject::connect(&workbench.history, &RunHistory::changed, &row, suggest);
}

}  // namespace evical::ui
