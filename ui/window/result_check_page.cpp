// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/result_check_page.h"

#include "core/pipeline/check/check_files.h"
#include "ui/screens/assessment/old_result_row.h"
#include "ui/screens/assessment/result_check_screen.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/window/old_result.h"
#include "ui/window/page_work.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QFileDialog>
#include <QFileInfo>

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

void startResultCheck(ResultCheckScreen& screen, Workbench& workbench) {
  const std::filesystem::path result = screen.result().path().toStdString();
  const QString recording = screen.recording().path();
  std::function<CheckInput()> read = [result, path = recording.toStdString()] {
    return readCheckInput({result, path, {}});
  };
  if (isOpen(recording, workbench.document))
    read = [result, session = workbench.document.session()] { return readCheckInput(result, session); };
  workbench.result_check.start(std::move(read), workbench.version);
}

// What is open and has no result yet is the new one.
void proposeResultCheck(ResultCheckScreen& screen, const CalibrationDocument& document) {
  screen.recording().proposePath(document.hasSession() && !document.last().run ? openFileOf(document)
                                                                               : QString());
}

void chooseRecording(ResultCheckScreen& screen) {
  const QString file =
      QFileDialog::getOpenFileName(&screen, QObject::tr("The new recording, or a session of it"),
                                   lastUsedFolder(), recordingsFilter(true));
  if (!file.isEmpty()) screen.recording().setPath(file);
}

void saveResultCheck(ResultCheckScreen& screen, const std::shared_ptr<const CheckedResult>& checked,
                     Workbench& workbench, SessionFiles& files) {
  const auto write = [checked, version = workbench.version](const std::filesystem::path& folder) {
    writeCheckFiles(folder, checked->input, checked->run, version.toStdString(), checked->log.toStdString());
  };
  saveToFolder(screen, {QObject::tr("Save the check"), QObject::tr("The check was saved")}, write, workbench,
               files);
}

}  // namespace

void wireResultCheck(ResultCheckScreen& screen, Workbench& workbench, SessionFiles& files) {
  ResultCheckJob& job = workbench.result_check;
  wireOldResult(screen.result(), screen, workbench);
  wireWork(screen.work(), workbench.runner, [&job] { return job.running(); });
  const CalibrationDocument& document = workbench.document;
  const auto suggest = [&screen, &document] { proposeResultCheck(screen, document); };
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen, suggest);
  QObject::connect(&document, &CalibrationDocument::sessionReplaced, &screen, suggest);
  QObject::connect(&document, &CalibrationDocument::fileChanged, &screen, suggest);
  QObject::connect(&screen.recording(), &PathRow::chooseRequested, &screen,
                   [&screen] { chooseRecording(screen); });
  QObject::connect(&screen, &ResultCheckScreen::checkRequested, &screen,
                   [&screen, &workbench] { startResultCheck(screen, workbench); });
  QObject::connect(&screen, &ResultCheckScreen::cancelRequested, &workbench.runner, &JobRunner::cancel);
  const auto kept = std::make_shared<std::shared_ptr<const CheckedResult>>();
  QObject::connect(&job, &ResultCheckJob::checked, &screen,
                   [&screen, kept](const std::shared_ptr<const CheckedResult>& checked) {
                     *kept = checked;
                     screen.setCheck(checked->run.check);
                   });
  QObject::connect(&screen, &ResultCheckScreen::saveRequested, &screen, [&screen, kept, &workbench, &files] {
    if (*kept) saveResultCheck(screen, *kept, workbench, files);
  });
}

}  // namespace evical::ui
