// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/page_work.h"

#include "core/base/file_places.h"
#include "core/data/calibration_observer.h"
#include "core/pipeline/maintain/maintain_imus.h"
#include "ui/screens/assessment/work_bar.h"
#include "ui/window/session_files.h"
#include "ui/window/workbench.h"

#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QPushButton>
#include <QSettings>

#include <utility>

namespace evical::ui {
namespace {

// "bag_2 (2 of 3): Read and detect".
QString titleOf(const JobProgress& progress) {
  QString title = progress.stage;
  for (const StageRow& row : kCalibrationStages)
    if (title == row.name) title = QObject::tr(row.title);
  for (const MaintainStage& stage : kMaintainStages)
    if (title == stage.name) title = QObject::tr(stage.title);
  return progress.part.isEmpty() ? title : progress.part + ": " + title;
}

QString recordingsFilter(RecordingChoice choice) {
  const QString recordings =
      "*.bag *.bag.active *.mcap *.db3 *.zstd *.aedat4 *.aedat *.raw *.dat *.h5 *.npz *.npy *.hdf5 *.es "
      "*.txt *.csv";
  const QString all = QObject::tr("All files (*)");
  if (choice == RecordingChoice::RecordingsAndSessions)
    return QObject::tr("Recordings, sessions and results (%1 *.yaml *.yml);;%2").arg(recordings, all);
  return QObject::tr("Recordings (%1);;%2").arg(recordings, all);
}

}  // namespace

void wireWork(WorkBar& bar, JobRunner& runner, std::function<bool()> own) {
  // The owner of a job is known only after its start or end has been signalled.
  const auto show = [&bar, &runner, own] { bar.setRunning(own() && runner.running(), runner.running()); };
  QObject::connect(&runner, &JobRunner::started, &bar, show);
  QObject::connect(&runner, &JobRunner::finished, &bar, show);
  QObject::connect(&runner, &JobRunner::progressed, &bar, [&bar](const JobProgress& progress) {
    bar.setProgress(titleOf(progress), progress.fraction);
  });
}

void saveToFolder(QWidget& page, const SavedWords& words,
                  std::function<void(const std::filesystem::path&)> write, Workbench& workbench,
                  SessionFiles& files) {
  const QString folder = QFileDialog::getExistingDirectory(
      &page, QObject::tr("%1 to a folder").arg(words.title), lastUsedFolder());
  if (folder.isEmpty()) return;
  const bool begun =
      workbench.runner.start(words.title, {}, [folder, write = std::move(write)](const RunContext&) {
        const NewFolder made(folder.toStdString());
        write(folder.toStdString());
      });
  if (!begun) return;
  QObject::connect(
      &workbench.runner, &JobRunner::finished, &files,
      [&files, folder, saved = words.saved](JobOutcome outcome) {
        ExportOutcome written{folder, {}, {}, false, {}, saved};
        if (outcome == JobOutcome::Done) emit files.exported(written);
      },
      Qt::SingleShotConnection);
}

QString openFileOf(const CalibrationDocument& document) {
  if (!document.hasSession()) return {};
  return document.file().isEmpty() ? QString::fromStdString(document.session().recording.string())
                                   : document.file();
}

QString lastUsedFolder() {
  return QSettings().value("last_folder", QDir::homePath()).toString();
}

QStringList askForRecordings(QWidget* parent, const QString& title, RecordingChoice choice, bool several) {
  QFileDialog dialog(parent, title, lastUsedFolder(), recordingsFilter(choice));
  dialog.setOption(
      QFileDialog::DontUseNativeDialog);  // desktops' dialogs choose files or folders, never both
  dialog.setFileMode(several ? QFileDialog::ExistingFiles : QFileDialog::ExistingFile);
  QPushButton* const use_folder = dialog.findChild<QDialogButtonBox*>()->addButton(
      QObject::tr("Use this &folder"), QDialogButtonBox::ActionRole);
  use_folder->setObjectName("use_folder");
  use_folder->setToolTip(
      QObject::tr("The marked folder, or the one that is shown: pictures, text files or a ROS 2 bag"));
  QString folder;
  QObject::connect(use_folder, &QPushButton::clicked, &dialog, [&dialog, &folder] {
    const QStringList marked = dialog.selectedFiles();
    folder =
        !marked.isEmpty() && QFileInfo(marked.front()).isDir() ? marked.front() : dialog.directory().path();
    static_cast<QDialog&>(dialog).done(QDialog::Accepted);
  });
  if (dialog.exec() != QDialog::Accepted) return {};
  return folder.isEmpty() ? dialog.selectedFiles() : QStringList{folder};
}

QString askForRecording(QWidget* parent, const QString& title, RecordingChoice choice) {
  return askForRecordings(parent, title, choice, false).value(0);
}

}  // namespace evical::ui
