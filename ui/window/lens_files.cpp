// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/lens_files.h"

#include "core/base/error.h"
#include "core/pipeline/lens/intrinsics_files.h"
#include "ui/screens/lens/lens_screen.h"

#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QSettings>

#include <algorithm>
#include <memory>

namespace evical::ui {
namespace {

const char* const kLensFolderKey = "last_folder";

std::vector<FileContent> lensFilesOf(const LensRecord& record, const QString& version,
                                     const std::filesystem::path& folder) {
  std::vector<FileContent> files =
      intrinsicsFiles(folder, namedLens(record, version), record.run->detections.cameras);
  files.push_back({folder / "log.txt", record.log.toStdString()});
  return files;
}

}  // namespace

NamedIntrinsics namedLens(const LensRecord& record, const QString& version) {
  return namedIntrinsics(record.session.cameras.at(record.camera), *record.run, version.toStdString());
}

LensFiles::LensFiles(Workbench& workbench, QWidget* window)
    : QObject(window), workbench_(workbench), window_(window) {}

QString LensFiles::lastFolder() const {
  return QSettings().value(kLensFolderKey, QDir::homePath()).toString();
}

void LensFiles::chooseOther() {
  const QString file = QFileDialog::getOpenFileName(window_, tr("Compare with a lens"), lastFolder(),
                                                    tr("YAML (*.yaml *.yml);;All files (*)"));
  if (file.isEmpty()) return;
  try {
    workbench_.lens.loadOther(file);
  } catch (const CalibrationError& error) {
    emit failed(tr("%1 cannot be used for the comparison").arg(QFileInfo(file).fileName()), errorOf(error));
  }
}

void LensFiles::chooseFile(int file) {
  if (!workbench_.lens.last().run) return;
  const QString proposal = QDir(lastFolder()).filePath(kLensFiles.at(static_cast<std::size_t>(file)).name);
  const QString path = QFileDialog::getSaveFileName(
      window_, tr("Save the lens"), proposal,
      QFileInfo(proposal).suffix() == "csv" ? tr("Tables (*.csv)") : tr("YAML (*.yaml *.yml)"));
  if (!path.isEmpty()) saveTo(file, path);
}

void LensFiles::chooseFolder() {
  if (!workbench_.lens.last().run) return;
  const QString folder =
      QFileDialog::getExistingDirectory(window_, tr("Save all files of the lens to a folder"), lastFolder());
  if (!folder.isEmpty()) saveAllTo(folder);
}

void LensFiles::chooseFolderFor(const QString& program) {
  if (!workbench_.lens.last().run) return;
  const QString folder =
      QFileDialog::getExistingDirectory(window_, tr("Export the lens to a folder"), lastFolder());
  if (!folder.isEmpty()) exportTo(program, folder);
}

void LensFiles::saveTo(int file, const QString& path) {
  const std::string name = kLensFiles.at(static_cast<std::size_t>(file)).name;
  write(path, {}, [record = workbench_.lens.last(), version = workbench_.version, name, path] {
    ExportedFiles made;
    for (FileContent& each : lensFilesOf(record, version, {}))
      if (each.path == name) made.files.push_back({path.toStdString(), std::move(each.content)});
    return made;
  });
}

void LensFiles::saveAllTo(const QString& folder) {
  write(folder, folder, [record = workbench_.lens.last(), version = workbench_.version, folder] {
    ExportedFiles made;
    made.files = lensFilesOf(record, version, folder.toStdString());
    return made;
  });
}

void LensFiles::exportTo(const QString& program, const QString& folder) {
  const std::filesystem::path below = folder.toStdString();
  write(folder, folder, [record = workbench_.lens.last(), version = workbench_.version, program, below] {
    const CameraKind kind = record.run->detections.cameras.front().kind;
    const std::vector<std::string> targets = {program.toStdString()};
    ExportedFiles made = exportResult(lensAsResult(namedLens(record, version), kind), targets);
    for (FileContent& file : made.files) file.path = below / file.path;
    return made;
  });
}

// `folder`: created if it does not exist; empty if the path contains its folder.
void LensFiles::write(const QString& path, const QString& folder, Make make) {
  if (!workbench_.lens.last().run) return;
  const auto begun = workbench_.runner.start(tr("Save the lens"), {},
                                             [make = std::move(make), folder](const RunContext& context) {
                                               if (!folder.isEmpty()) makeOutputFolder(folder.toStdString());
                                               const ExportedFiles made = make();
                                               for (const FileContent& file : made.files)
                                                 if (file.path.has_parent_path())
                                                   makeOutputFolder(file.path.parent_path());
                                               writeFilesWhole(made.files);
                                               for (const std::string& note : made.notes)
                                                 context.progress.log(LogLevel::Info, note);
                                             });
  if (!begun) {
    emit failed(tr("The lens was not saved"),
                {true, workbench_.runner.title(), tr("is still running"), tr("Cancel it, or wait")});
    return;
  }
  connect(
      &workbench_.runner, &JobRunner::finished, this,
      [this, path, folder](JobOutcome outcome) {
        if (outcome != JobOutcome::Done) return;
        QSettings().setValue(kLensFolderKey, folder.isEmpty() ? QFileInfo(path).path() : folder);
        emit saved(path);
      },
      Qt::SingleShotConnection);
}

}  // namespace evical::ui
