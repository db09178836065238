// SPDX-License-Identifier: GPL-3.0-or-later
// F1: the guide that is embedded in the program, in a window of its own; and About.
#pragma once

#include <QString>

class QWidget;

namespace evical::ui {

void showUserGuide(QWidget* window);  // brings it to the front if it is open
void showAbout(QWidget* window, const QString& version);

}  // namespace evical::ui
