// SPDX-License-Identifier: GPL-3.0-or-later
// What pages with a job of their own have in common.
#pragma once

#include <QString>

#include <filesystem>
#include <functional>

class QWidget;

namespace evical::ui {

class CalibrationDocument;
class JobRunner;
class SessionFiles;
class WorkBar;
struct Workbench;

// The bar follows the runner; `own` tells whether what runs is the page's.
void wireWork(WorkBar& bar, JobRunner& runner, std::function<bool()> own);

// Into a folder that a person chooses; `saved` is said when it is there.
struct SavedWords {
  QString title, saved;
};
void saveToFolder(QWidget& page, const SavedWords& words,
                  std::function<void(const std::filesystem::path& folder)> write, Workbench& workbench,
                  SessionFiles& files);

// The session's file, else its recording; empty where nothing is open.
QString openFileOf(const CalibrationDocument& document);

QString lastUsedFolder();                      // where files were opened from last
QString recordingsFilter(bool with_sessions);  // for file dialogs

}  // namespace evical::ui
