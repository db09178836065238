// SPDX-License-Identifier: GPL-3.0-or-later
// Files in and out: sessions, recordings, the demo, results; asks about
// unsaved changes, remembers recent files.
#pragma once

#include "ui/window/export_dialog.h"
#include "ui/window/export_notice.h"
#include "ui/window/workbench.h"

#include <QObject>
#include <QStringList>
#include <QTemporaryDir>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class QWidget;

namespace evical {
struct SavedRun;
}

namespace evical::ui {

class SessionFiles : public QObject {
  Q_OBJECT

 public:
  SessionFiles(Workbench& workbench, QWidget* window);

  void open(const QString& path);  // a session file, a recording, a saved run, or a folder with one of them
  void chooseSession();
  void chooseRecording();
  // A recording beside the session's, for sensors that it lacks.
  void chooseFurtherRecording();
  void addRecording(const QString& path);
  // Asks where a recording is that is not at its place any more.
  void lookForRecording(const QString& missing);
  bool save();
  bool saveAs();
  void openDemo();  // simulates it the first time
  void chooseReference();
  void chooseExportFolder();
  void exportTo(const QString& folder);
  // Every result goes to a folder that is asked for now, as soon as it is there; until another session comes.
  void exportEveryResult(bool wanted);
  // report.html of the last result, in the browser; written to a folder for the moment if no export has it.
  void openReport();

  // False if the person would rather keep what is not saved.
  bool mayDiscard();
  QStringList recentFiles() const;

 signals:
  void opened();
  void recentFilesChanged(const QStringList& files);
  void demoRunning(bool running);
  void exported(const evical::ui::ExportOutcome& outcome);
  void exportsEveryResult(bool does);
  void failed(const QString& what_was_tried, const evical::ui::JobError& error);

 private:
  void openSession(const QString& file);
  void openRecording(const QString& path);
  void openRun(const QString& path);
  void runOpened(const SavedRun& saved);
  bool saveTo(const QString& file);
  void remember(const QString& file);
  void recordingInspected(const QString& recording, const Inspection& inspection);
  void furtherRecordingInspected(const QString& recording, const Inspection& inspection);
  void takeResolutions(const QString& recording, const Inspection& inspection);
  bool refuseUseless(const QString& recording, const Inspection& inspection);  // false for what is useful
  QString askForRecording(const QString& title);
  void inspectSession();
  QString lastFolder() const;
  void startExport(const ExportRequest& request);
  void writeResult(const QString& title, const ExportRequest& request,
                   const std::function<void(const ExportOutcome&)>& written);
  void showReport();

  Workbench& workbench_;
  QWidget* window_;
  QString every_result_folder_;                             // empty: results are not exported by themselves
  QString awaited_recording_;                               // opened as soon as it has been looked through
  QStringList further_recordings_;                          // added to the session as soon as they have been
  std::optional<std::vector<std::string>> export_targets_;  // chosen by hand; else as the session says
  std::shared_ptr<const CalibrationRun> reported_run_;      // the run that report_folder_ is of
  QString report_folder_;
  QTemporaryDir momentary_;
};

}  // namespace evical::ui
