// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/repeat_page.h"

#include "core/base/error.h"
#include "core/pipeline/repeat/repeat_files.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/repeat_screen.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/window/page_work.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QDesktopServices>
#include <QDir>
#include <QFileDialog>
#include <QUrl>

#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {
namespace {

using Repeated = std::shared_ptr<const RepeatedRecordings>;

RepeatInput inputOf(const QStringList& files, const CalibrationDocument& document) {
  if (document.modified() && files.contains(document.file()))
    throw badInput(document.file().toStdString(), "has changes that are not saved",
                   "Save the session first: its file is read");
  std::vector<std::filesystem::path> paths;
  for (const QString& file : files) paths.emplace_back(file.toStdString());
  return readRepeat(paths, document.hasSession() ? std::optional(document.session()) : std::nullopt);
}

void startRepeat(RepeatScreen& screen, Workbench& workbench, SessionFiles& files) {
  const QString folder = screen.folder().path();
  try {
    checkRepeatFolder(folder.toStdString());
    workbench.repeat.start(inputOf(screen.files().files(), workbench.document), folder, workbench.version);
  } catch (const CalibrationError& error) {
    emit files.failed(QObject::tr("These recordings cannot be calibrated together"), errorOf(error));
  }
}

void proposeRepeat(RepeatScreen& screen) {
  const QStringList files = screen.files().files();
  screen.folder().proposePath(files.isEmpty() ? QString() : newResultFolder(files.front(), "repeat"));
}

void chooseFilesRepeat(RepeatScreen& screen) {
  QObject::connect(&screen.files(), &FileList::addRequested, &screen, [&screen] {
    screen.files().add(QFileDialog::getOpenFileNames(
        &screen, QObject::tr("Recordings or sessions of one rig"), lastUsedFolder(), recordingsFilter(true)));
  });
  QObject::connect(&screen.folder(), &PathRow::chooseRequested, &screen, [&screen] {
    const QString folder =
        QFileDialog::getExistingDirectory(&screen, QObject::tr("Where the results go"), lastUsedFolder());
    if (!folder.isEmpty()) screen.folder().setPath(folder);
  });
}

void show(const QString& path, SessionFiles& files) {
  if (QDesktopServices::openUrl(QUrl::fromLocalFile(path))) return;
  emit files.failed(QObject::tr("%1 cannot be shown").arg(QDir::toNativeSeparators(path)),
                    {true, {}, QObject::tr("no program of this desktop opens it"), {}});
}

}  // namespace

void wireRepeat(RepeatScreen& screen, Workbench& workbench, SessionFiles& files) {
  RepeatJob& job = workbench.repeat;
  chooseFilesRepeat(screen);
  wireWork(screen.work(), workbench.runner, [&job] { return job.running(); });
  const auto show_open = [&screen, &workbench] { screen.setOpenFile(openFileOf(workbench.document)); };
  QObject::connect(&workbench.document, &CalibrationDocument::sessionReplaced, &screen, show_open);
  QObject::connect(&workbench.document, &CalibrationDocument::fileChanged, &screen, show_open);
  QObject::connect(&screen.files(), &FileList::changed, &screen, [&screen] { proposeRepeat(screen); });
  QObject::connect(&screen, &RepeatScreen::repeatRequested, &screen,
                   [&screen, &workbench, &files] { startRepeat(screen, workbench, files); });
  QObject::connect(&screen, &RepeatScreen::cancelRequested, &workbench.runner, &JobRunner::cancel);
  const auto kept = std::make_shared<Repeated>();
  QObject::connect(&job, &RepeatJob::repeated, &screen, [&screen, kept](const Repeated& repeated) {
    *kept = repeated;
    screen.setRepeat(repeated->run.repeatability);
  });
  QObject::connect(&screen, &RepeatScreen::openFolderRequested, &files, [kept, &files] {
    if (*kept) show((*kept)->folder, files);
  });
  QObject::connect(&screen, &RepeatScreen::reportRequested, &files, [kept, &files] {
    if (*kept) show(QDir((*kept)->folder).filePath("report.html"), files);
  });
  QObject::connect(&screen, &RepeatScreen::openResultRequested, &files, [kept, &files](int recording) {
    if (!*kept) return;
    const std::filesystem::path folder = (*kept)->folder.toStdString();
    files.open(QString::fromStdString(
        (recording < 0 ? folder : folderOf(folder, (*kept)->input, static_cast<std::size_t>(recording)))
            .string()));
  });
}

}  // namespace evical::ui
