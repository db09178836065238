// SPDX-License-Identifier: GPL-3.0-or-later
// What pages with a job of their own have in common.
#pragma once

#include <QString>

#include <functional>

namespace evical::ui {

class CalibrationDocument;
class JobRunner;
class WorkBar;

// The bar follows the runner; `own` tells whether what runs is the page's.
void wireWork(WorkBar& bar, JobRunner& runner, std::function<bool()> own);

// The session's file, else its recording; empty where nothing is open.
QString openFileOf(const CalibrationDocument& document);

QString lastUsedFolder();                      // where files were opened from last
QString recordingsFilter(bool with_sessions);  // for file dialogs

}  // namespace evical::ui
