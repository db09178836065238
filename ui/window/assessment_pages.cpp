// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/assessment_pages.h"

#include "core/base/error.h"
#include "core/pipeline/check/check_files.h"
#include "core/pipeline/maintain/maintain_files.h"
#include "core/pipeline/repeat/repeat_files.h"
#include "core/report/result_yaml.h"
#include "ui/plots/maintenance_charts.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/maintain_screen.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/repeat_screen.h"
#include "ui/screens/assessment/result_check_screen.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/screens/result/runs_panel.h"
#include "ui/window/page_work.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QDesktopServices>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QUrl>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace evical::ui {
namespace {

// Common connections of these pages. `start` may throw CalibrationError, which is shown under the title
// `refused`.
void wirePage(AssessmentScreen& screen, const TaskJob& job, std::function<void()> start,
              const QString& refused, Workbench& workbench, SessionFiles& files) {
  wireWork(screen.work(), workbench.runner, [&job] { return job.running(); });
  QObject::connect(&screen, &AssessmentScreen::startRequested, &screen,
                   [start = std::move(start), refused, &files] {
                     try {
                       start();
                     } catch (const CalibrationError& error) {
                       emit files.failed(refused, errorOf(error));
                     }
                   });
  QObject::connect(&screen, &AssessmentScreen::cancelRequested, &workbench.runner, &JobRunner::cancel);
}

void wireFile(PathRow& row, QWidget& page, const QString& title, const QString& filter) {
  QObject::connect(&row, &PathRow::chooseRequested, &page, [&row, &page, title, filter] {
    const QString file = QFileDialog::getOpenFileName(&page, title, lastUsedFolder(), filter);
    if (!file.isEmpty()) row.setPath(file);
  });
}

void wireList(FileList& list, QWidget& page, const QString& title, RecordingChoice choice) {
  QObject::connect(&list, &FileList::addRequested, &page,
                   [&list, &page, title, choice] { list.add(askForRecordings(&page, title, choice, true)); });
}

std::vector<std::filesystem::path> pathsOf(const FileList& list) {
  std::vector<std::filesystem::path> paths;
  for (const QString& file : list.files()) paths.emplace_back(file.toStdString());
  return paths;
}

// The open session is used as shown in the window, even if it is not saved.
bool isOpen(const QString& path, const CalibrationDocument& document) {
  if (!document.hasSession()) return false;
  const QFileInfo info(path);
  return info == QFileInfo(document.file()) ||
         info == QFileInfo(QString::fromStdString(document.session().recording.string()));
}

void beginResultCheck(ResultCheckScreen& screen, Workbench& workbench) {
  const std::filesystem::path result = screen.result().path().toStdString();
  const QString recording = screen.recording().path();
  std::function<CheckInput()> read = [result, path = recording.toStdString()] {
    return readCheckInput({result, path, {}});
  };
  if (isOpen(recording, workbench.document))
    read = [result, session = workbench.document.session()] { return readCheckInput(result, session); };
  startResultCheck(workbench.result_check, std::move(read), workbench.version);
}

void beginMaintain(MaintainScreen& screen, Workbench& workbench) {
  const auto read = [logs = pathsOf(screen.logs()), result = screen.result().path().toStdString(),
                     settings = screen.settings(), options = workbench.document.session().options.maintain,
                     trajectory = screen.trajectory().path().toStdString()] {
    MaintainInput input = readMaintainInput(logs, result);
    input.settings = settings;
    input.options = options;
    input.trajectory = trajectory;
    return input;
  };
  startMaintain(workbench.maintain, read, workbench.version);
}

void beginRepeat(RepeatScreen& screen, Workbench& workbench) {
  const CalibrationDocument& document = workbench.document;
  const QString folder = screen.folder().path();
  checkRepeatFolder(folder.toStdString());
  if (document.modified() && screen.files().files().contains(document.file()))
    throw badInput(document.file().toStdString(), "has unsaved changes",
                   "Save the session first: the file is read");
  startRepeat(workbench.repeat,
              readRepeat(pathsOf(screen.files()),
                         document.hasSession() ? std::optional(document.session()) : std::nullopt),
              folder, workbench.version);
}

void show(const QString& path, SessionFiles& files) {
  if (QDesktopServices::openUrl(QUrl::fromLocalFile(path))) return;
  emit files.failed(QObject::tr("%1 cannot be shown").arg(QDir::toNativeSeparators(path)),
                    {true, {}, QObject::tr("no program on this computer opens it"), {}});
}

// The repeat has already written its files.
void wireRepeatedFiles(RepeatScreen& screen, const RepeatJob& job, SessionFiles& files) {
  QObject::connect(&screen, &RepeatScreen::openFolderRequested, &files, [&job, &files] {
    if (job.found()) show(job.found()->folder, files);
  });
  QObject::connect(&screen, &RepeatScreen::reportRequested, &files, [&job, &files] {
    if (job.found()) show(QDir(job.found()->folder).filePath("report.html"), files);
  });
  QObject::connect(&screen, &RepeatScreen::openResultRequested, &files, [&job, &files](int recording) {
    if (!job.found()) return;
    const std::filesystem::path folder = job.found()->folder.toStdString();
    const std::filesystem::path result =
        recording < 0 ? folder : folderOf(folder, job.found()->input, static_cast<std::size_t>(recording));
    files.open(QString::fromStdString(result.string()));
  });
}

}  // namespace

void wireResultCheck(ResultCheckScreen& screen, Workbench& workbench, SessionFiles& files) {
  ResultCheckJob& job = workbench.result_check;
  wireOldResult(screen.result(), screen, workbench);
  QObject::connect(&screen.recording(), &PathRow::chooseRequested, &screen, [&screen] {
    const QString path = askForRecording(&screen, QObject::tr("New recording, or a session of it"),
                                         RecordingChoice::RecordingsAndSessions);
    if (!path.isEmpty()) screen.recording().setPath(path);
  });
  wirePage(
      screen, job, [&screen, &workbench] { beginResultCheck(screen, workbench); },
      QObject::tr("The result cannot be checked"), workbench, files);
  // Proposes the open recording if it has no result yet.
  const CalibrationDocument& document = workbench.document;
  const auto suggest = [&screen, &document] {
    const bool is_new = document.hasSession() && !document.last().run;
    screen.recording().proposePath(is_new ? openFileOf(document) : QString());
  };
  QObject::connect(&document, &CalibrationDocument::runsChanged, &screen, suggest);
  QObject::connect(&document, &CalibrationDocument::sessionReplaced, &screen, suggest);
  QObject::connect(&document, &CalibrationDocument::fileChanged, &screen, suggest);
  QObject::connect(&job, &TaskJob::done, &screen,
                   [&screen, &job] { screen.setCheck(job.found()->run.check); });
  QObject::connect(&screen, &AssessmentScreen::saveRequested, &screen, [&screen, &job, &workbench, &files] {
    const auto write = [found = job.found(), log = job.log().toStdString(),
                        version = workbench.version.toStdString()](const std::filesystem::path& folder) {
      writeCheckFiles(folder, found->input, found->run, version, log);
    };
    saveToFolder(screen, {QObject::tr("Save the check"), QObject::tr("The check was saved")}, write,
                 workbench, files);
  });
}

void wireMaintain(MaintainScreen& screen, MaintenanceCharts& charts, Workbench& workbench,
                  SessionFiles& files) {
  MaintainJob& job = workbench.maintain;
  wireList(screen.logs(), screen, QObject::tr("Logs of the IMUs"), RecordingChoice::Recordings);
  wireOldResult(screen.result(), screen, workbench);
  wireFile(screen.trajectory(), screen, QObject::tr("Trajectory of the reference IMU"),
           QObject::tr("Trajectories (*.csv *.txt *.tum);;All files (*)"));
  wirePage(
      screen, job, [&screen, &workbench] { beginMaintain(screen, workbench); },
      QObject::tr("The logs cannot be checked"), workbench, files);
  QObject::connect(&job, &TaskJob::done, &screen, [&screen, &charts, &job] {
    screen.setMaintenance(*job.found());
    charts.setMaintenance(*job.found());
  });
  QObject::connect(&screen, &AssessmentScreen::saveRequested, &screen, [&screen, &job, &workbench, &files] {
    const auto write = [found = job.found(),
                        log = job.log().toStdString()](const std::filesystem::path& folder) {
      writeMaintenanceFiles(folder, *found, log);
    };
    saveToFolder(screen,
                 {QObject::tr("Save the maintenance"), QObject::tr("The maintenance of the IMUs was saved")},
                 write, workbench, files);
  });
}

void wireRepeat(RepeatScreen& screen, Workbench& workbench, SessionFiles& files) {
  RepeatJob& job = workbench.repeat;
  wireList(screen.files(), screen, QObject::tr("Recordings or sessions of one rig"),
           RecordingChoice::RecordingsAndSessions);
  QObject::connect(&screen.folder(), &PathRow::chooseRequested, &screen, [&screen] {
    const QString folder =
        QFileDialog::getExistingDirectory(&screen, QObject::tr("Folder for the results"), lastUsedFolder());
    if (!folder.isEmpty()) screen.folder().setPath(folder);
  });
  wirePage(
      screen, job, [&screen, &workbench] { beginRepeat(screen, workbench); },
      QObject::tr("The recordings cannot be calibrated together"), workbench, files);
  const auto show_open = [&screen, &workbench] { screen.setOpenFile(openFileOf(workbench.document)); };
  QObject::connect(&workbench.document, &CalibrationDocument::sessionReplaced, &screen, show_open);
  QObject::connect(&workbench.document, &CalibrationDocument::fileChanged, &screen, show_open);
  QObject::connect(&screen.files(), &FileList::changed, &screen, [&screen] {
    const QStringList all = screen.files().files();
    screen.folder().proposePath(all.isEmpty() ? QString() : newResultFolder(all.front(), "repeat"));
  });
  QObject::connect(&job, &TaskJob::done, &screen,
                   [&screen, &job] { screen.setRepeat(job.found()->run.repeatability); });
  wireRepeatedFiles(screen, job, files);
}

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
