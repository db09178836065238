// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/kept_runs.h"

#include "ui/screens/result/result_screen.h"
#include "ui/screens/result/runs_panel.h"
#include "ui/window/workbench.h"

#include <algorithm>

namespace evical::ui {
namespace {

std::filesystem::path pathOf(const QString& folder) {
  return std::filesystem::path(folder.toStdString());
}

QString titleIn(const RunHistory& history, const QString& folder) {
  const auto found = std::find_if(history.runs().begin(), history.runs().end(),
                                  [&](const RunSummary& run) { return run.folder == pathOf(folder); });
  return found == history.runs().end() ? folder : titleOf(*found);
}

// The folder of the runs follows the session's file.
void followSession(Workbench& workbench) {
  const CalibrationDocument& document = workbench.document;
  RunHistory& history = workbench.history;
  QObject::connect(&document, &CalibrationDocument::sessionReplaced, &history, [&document, &history] {
    history.setSession(document.file(), document.session().recording);
  });
  QObject::connect(&document, &CalibrationDocument::fileChanged, &history, [&document, &history] {
    if (!document.file().isEmpty()) history.moveTo(document.file());
  });
  QObject::connect(
      &workbench.calibration, &CalibrationJob::calibrated, &history,
      [&workbench](const std::shared_ptr<const CalibrationRun>& run, const Session& session,
                   const QString& log) { workbench.history.keep(run, session, workbench.version, log); });
}

void showList(RunsPanel& panel, ResultScreen& result, const Workbench& workbench) {
  const RunHistory& history = workbench.history;
  const std::filesystem::path shown = history.folderOf(workbench.document.last().run);
  panel.setPlace(QString::fromStdString(history.place().string()));
  panel.setRuns(history.runs(), shown);
  std::vector<std::pair<QString, QString>> others;
  for (const RunSummary& run : history.runs())
    if (run.folder != shown) others.emplace_back(titleOf(run), QString::fromStdString(run.folder.string()));
  std::reverse(others.begin(), others.end());  // newest first
  result.setKeptRuns(others);
}

void open(Workbench& workbench, const QString& folder) {
  workbench.history.open(pathOf(folder), [&workbench, folder](const SavedRun& saved) {
    if (workbench.runner.running()) return;  // its result will be shown instead
    workbench.lens.setAim(CalibrationAim::Rig);
    workbench.document.addUndoableRun({saved.run, saved.session, QString::fromStdString(saved.log)},
                                      QObject::tr("Show %1").arg(titleIn(workbench.history, folder)));
  });
}

void compareWith(Workbench& workbench, const QString& folder) {
  workbench.history.openNumbers(pathOf(folder), [&workbench, folder](const NamedResult& named) {
    workbench.document.setReference({named, titleIn(workbench.history, folder)});
  });
}

}  // namespace

void wireRuns(RunsPanel& panel, ResultScreen& result, Workbench& workbench) {
  followSession(workbench);
  const auto show = [&panel, &result, &workbench] { showList(panel, result, workbench); };
  QObject::connect(&workbench.history, &RunHistory::changed, &panel, show);
  QObject::connect(&workbench.document, &CalibrationDocument::runsChanged, &panel, show);
  QObject::connect(&workbench.runner, &JobRunner::started, &panel, [&panel] { panel.setBusy(true); });
  QObject::connect(&workbench.runner, &JobRunner::finished, &panel, [&panel] { panel.setBusy(false); });
  QObject::connect(&panel, &RunsPanel::openRequested, &panel,
                   [&workbench](const QString& folder) { open(workbench, folder); });
  QObject::connect(&panel, &RunsPanel::comparisonRequested, &panel,
                   [&workbench](const QString& folder, const QString& with_folder) {
                     if (!folder.isEmpty()) open(workbench, folder);
                     compareWith(workbench, with_folder);
                   });
  QObject::connect(&result, &ResultScreen::keptRunRequested, &panel,
                   [&workbench](const QString& folder) { compareWith(workbench, folder); });
  QObject::connect(&panel, &RunsPanel::renameRequested, &panel,
                   [&workbench](const QString& folder, const QString& name) {
                     workbench.history.rename(pathOf(folder), name);
                   });
  QObject::connect(&panel, &RunsPanel::deletionRequested, &panel, [&workbench](const QStringList& folders) {
    std::vector<std::filesystem::path> paths;
    for (const QString& folder : folders) paths.push_back(pathOf(folder));
    workbench.history.remove(paths);
  });
}

}  // namespace evical::ui
