// SPDX-License-Identifier: GPL-3.0-or-later
// Common parts of pages with a job of their own.
#pragma once

#include <QString>
#include <QStringList>

#include <filesystem>
#include <functional>

class QWidget;

namespace evical::ui {

class CalibrationDocument;
class JobRunner;
class SessionFiles;
class WorkBar;
struct Workbench;

// The bar follows the runner; `own` returns whether the running job is the page's.
void wireWork(WorkBar& bar, JobRunner& runner, std::function<bool()> own);

// Saves into a folder that the user chooses; `saved` is the title of the notice.
struct SavedWords {
  QString title, saved;
};
void saveToFolder(QWidget& page, const SavedWords& words,
                  std::function<void(const std::filesystem::path& folder)> write, Workbench& workbench,
                  SessionFiles& files);

// The session's file, else its recording; empty without a session.
QString openFileOf(const CalibrationDocument& document);

QString lastUsedFolder();  // folder of the last opened file

enum class RecordingChoice { Recordings, RecordingsAndSessions };
// Asks for recordings, which are files or folders (of pictures, text or a ROS 2 bag): a button of the dialog
// chooses the folder that it shows or marks. Empty if the user cancels.
QStringList askForRecordings(QWidget* parent, const QString& title, RecordingChoice choice, bool several);
QString askForRecording(QWidget* parent, const QString& title, RecordingChoice choice);

}  // namespace evical::ui
