// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/result_check_page.h"

#include "core/base/new_folder.h"
#include "core/pipeline/check_files.h"
#include "ui/screens/path_row.h"
#include "ui/screens/result_check_screen.h"
#include "ui/screens/runs_panel.h"
#include "ui/screens/work_bar.h"
#include "ui/window/page_work.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QFileDialog>
#include <QFileInfo>

#include <algorithm>
#include <memory>

namespace evical::ui {
namespace {

// What is open is taken as it is in the window, also where it is not saved.
bool isOpen(const QString& path, const CalibrationDocument& document) {
  if (!document.hasSession()) return false;
  const QFileInfo info(path);
  return info == QFileInfo(document.file()) ||
         info == QFileInfo(QString::fromStdString(document.session().recording.string()));
}

void start(ResultCheckScreen& screen, Workbench& workbench) {
  const std::filesystem::path result = screen.result().path().toStdString();
  const QString recording = screen.recording().path();
  std::function<CheckInput()> read = [result, path = recording.toStdString()] {
    return readCheckInput({result, path, {}});
  };
  if (isOpen(recording, workbench.document))
    read = [result, session = workbench.document.session()] { return readCheckInput(result, session); };
  workbench.result_check.start(std::move(read), workbench.version);
}

// The run that is shown is what a new recording is held against; a recording without one is itself the new one.
void propose(ResultCheckScreen& screen, const Workbench& workbench) {
  const CalibrationDocument& document = workbench.document;
  const QString shown = QString::fromStdString(workbench.history.folderOf(document.last().run).string());
  screen.result().proposePath(shown);
  screen.recording().proposePath(document.hasSession() && !document.last().run ? openFileOf(document)
                                                                               : QString());
  std::vector<std::pair<QString, QString>> runs;
  for (const RunSummary& run : workbench.history.runs())
    runs.emplace_back(titleOf(run), QString::fromStdString(run.folder.string()));
  std::reverse(runs.begin(), runs.end());  // the newest first
  screen.setKeptRuns(runs);
}

void chooseFiles(ResultCheckScreen& screen) {
  QObject::connect(&screen, &ResultCheckScreen::resultFolderRequested, &screen, [&screen] {
    const QString folder =
        QFileDialog::getExistingDirectory(&screen, QObject::tr("The old result's folder"), lastUsedFolder());
    if (!folder.isEmpty()) screen.result().setPath(folder);
  });
  QObject::connect(&screen, &ResultCheckScreen::resultFileRequested, &screen, [&screen] {
    const QString file =
        QFileDialog::getOpenFileName(&screen, QObject::tr("The old result"), lastUsedFolder(),
                                     QObject::tr("Results (*.yaml *.yml);;All files (*)"));
    if (!file.isEmpty()) screen.result().setPath(file);
  });
  QObject::connect(&screen.recording(), &PathRow::chooseRequested, &screen, [&screen] {
    const QString file =
        QFileDialog::getOpenFileName(&screen, QObject::tr("The new recording, or a session of it"),
                                     lastUsedFolder(), recordingsFilter(true));
    if (!file.isEmpty()) screen.recording().setPath(file);
  });
}

void save(ResultCheckScreen& screen, const std::shared_ptr<const CheckedResult>& checked,
          Workbench& workbench, SessionFiles& files) {
  const QString folder =
      QFileDialog::getExistingDirectory(&screen, QObject::tr("Save the check to a folder"), lastUsedFolder());
  if (folder.isEmpty()) return;
  const bool begun = workbench.runner.start(
      QObject::tr("Save the check"), {}, [checked, folder, version = workbench.version](const RunContext&) {
        const NewFolder made(folder.toStdString());
        writeCheckFiles(folder.toStdString(), checked->input, checked->run, version.toStdString(),
                        checked->log.toStdString());
      });
  if (!begun) return;
  QObject::connect(
      &workbench.runner, &JobRunner::finished, &files,
      [&files, folder](JobOutcome outcome) {
        ExportOutcome written{folder, {}, {}, false, {}, QObject::tr("The check was saved")};
        if (outcome == JobOutcome::Done) emit files.exported(written);
      },
      Qt::SingleShotConnection);
}

}  // namespace

void wireResultCheck(ResultCheckScreen& screen, Workbench& workbench, SessionFiles& files) {
  ResultCheckJob& job = workbench.result_check;
  chooseFiles(screen);
  wireWork(screen.work(), workbench.runner, [&job] { return job.running(); });
  const auto suggest = [&screen, &workbench] { propose(screen, workbench); };
  QObject::connect(&workbench.document, &CalibrationDocument::runsChanged, &screen, suggest);
  QObject::connect(&workbench.document, &CalibrationDocument::sessionReplaced, &screen, suggest);
  QObject::connect(&workbench.document, &CalibrationDocument::fileChanged, &screen, suggest);
  QObject::connect(&workbench.history, &RunHistory::changed, &screen, suggest);
  QObject::connect(&screen, &ResultCheckScreen::checkRequested, &screen,
                   [&screen, &workbench] { start(screen, workbench); });
  QObject::connect(&screen, &ResultCheckScreen::cancelRequested, &workbench.runner, &JobRunner::cancel);
  const auto kept = std::make_shared<std::shared_ptr<const CheckedResult>>();
  QObject::connect(&job, &ResultCheckJob::checked, &screen,
                   [&screen, kept](const std::shared_ptr<const CheckedResult>& checked) {
                     *kept = checked;
                     screen.setCheck(checked->run.check);
                   });
  QObject::connect(&screen, &ResultCheckScreen::saveRequested, &screen, [&screen, kept, &workbench, &files] {
    if (*kept) save(screen, *kept, workbench, files);
  });
}

}  // namespace evical::ui
