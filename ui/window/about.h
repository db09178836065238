// SPDX-License-Identifier: GPL-3.0-or-later
// About dialog: the program, its version, and its licences with their texts.
#pragma once

class QString;
class QWidget;

namespace evical::ui {

void showAbout(QWidget* window, const QString& version);

}  // namespace evical::ui
