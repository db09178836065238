// SPDX-License-Identifier: GPL-3.0-or-later
// Opens and saves sessions, recordings, the demo and results; asks about unsaved changes and stores the
// recent files.
#pragma once

#include "ui/window/error_panel.h"
#include "ui/window/export_dialog.h"
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
  // The same; also shows the newest run that is stored for it.
  void openRecent(const QString& path);
  void chooseSession();
  void chooseRecording();
  // Adds a recording to the session, for sensors that it lacks.
  void chooseFurtherRecording();
  void addRecording(const QString& path);
  // Asks for the new place of a missing recording.
  void lookForRecording(const QString& missing);
  bool save();
  bool saveAs();
  void openDemo();  // simulates it the first time
  void chooseReference();
  void chooseExportFolder();
  void exportTo(const QString& folder);
  // Exports every further result to a folder, which is chosen now; ends with the session.
  void exportEveryResult(bool wanted);
  // Opens report.html of the last result in the browser; written to a temporary folder if no export has it.
  void openReport();

  // False if the user wants to keep unsaved changes.
  bool mayDiscard();

 signals:
  void opened();
  // A recording that replaces the session when it has been read: its name; empty when that has ended.
  void reading(const QString& recording);
  void recentFilesChanged();
  void demoRunning(bool running);
  void exported(const evical::ui::ExportOutcome& outcome);
  void exportsEveryResult(bool does);
  void failed(const QString& what_was_tried, const evical::ui::JobError& error);

 private:
  void openSession(const QString& file);
  void openRecording(const QString& path);
  void await(const QString& recording);
  void openRun(const QString& path);
  void runOpened(const SavedRun& saved);
  void showNewestRun();
  bool saveTo(const QString& file);
  void remember(const QString& file);
  void rememberRun();
  void recordingInspected(const QString& recording, const Inspection& inspection);
  void furtherRecordingInspected(const QString& recording, const Inspection& inspection);
  void takeResolutions(const QString& recording, const Inspection& inspection);
  bool refuseUseless(const QString& recording,
                     const Inspection& inspection);  // false if the recording is useful
  void inspectSession();
  QString lastFolder() const;
  void startExport(const ExportRequest& request);
  void writeResult(const QString& title, const ExportRequest& request,
                   const std::function<void(const ExportOutcome&)>& written);
  void showReport();

  Workbench& workbench_;
  QWidget* window_;
  QString every_result_folder_;                             // empty: no automatic export
  QString awaited_recording_;                               // opened after its inspection
  QStringList further_recordings_;                          // added to the session after their inspection
  std::optional<std::vector<std::string>> export_targets_;  // chosen by the user; else those of the session
  std::shared_ptr<const CalibrationRun> reported_run_;      // run of report_folder_
  QString report_folder_;
  QTemporaryDir momentary_;
  bool newest_run_awaited_ = false;
};

}  // namespace evical::ui
