// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a lens into files and reads lenses of files for comparison: the dialogs, and the writing as a job.
#pragma once

#include "core/base/atomic_file.h"
#include "core/export/export_target.h"
#include "core/report/intrinsics_report.h"
#include "ui/window/workbench.h"

#include <QObject>
#include <QString>

#include <functional>
#include <vector>

namespace evical::ui {

// The document's last lens, with its names in files and on screens.
NamedIntrinsics namedLens(const LensRecord& record, const QString& version);

class LensFiles : public QObject {
  Q_OBJECT

 public:
  LensFiles(Workbench& workbench, QWidget* window);

  void chooseOther();
  void chooseFile(int file);  // index of kLensFiles
  void chooseFolder();        // for all of them
  void chooseFolderFor(const QString& program);

  void saveTo(int file, const QString& path);
  void saveAllTo(const QString& folder);
  void exportTo(const QString& program, const QString& folder);

 signals:
  void saved(const QString& path);
  void failed(const QString& what_was_tried, const evical::ui::JobError& error);

 private:
  // Runs in the job's thread; final paths.
  using Make = std::function<ExportedFiles()>;
  void write(const QString& path, const QString& folder, Make make);
  QString lastFolder() const;

  Workbench& workbench_;
  QWidget* window_;
};

}  // namespace evical::ui
