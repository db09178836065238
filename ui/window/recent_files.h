// SPDX-License-Identifier: GPL-3.0-or-later
// Files that were opened last, in the user's settings.
#pragma once

#include "ui/screens/recording/start_screen.h"

namespace evical::ui {

QList<RecentFile> recentFiles();  // existing ones, newest first
void rememberOpened(const QString& file);
// Verdict of the last calibration of a file; ignored unless the file is in the list.
void rememberVerdict(const QString& file, CalibrationStatus verdict);

}  // namespace evical::ui
