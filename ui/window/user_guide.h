// SPDX-License-Identifier: GPL-3.0-or-later
// F1: the guide that is embedded in the program, with its contents beside it, in a window of its own. Its last part, the
// keys, alone on "?".
#pragma once

class QWidget;

namespace evical::ui {

// They come to the front if they are open.
void showUserGuide(QWidget* window);
void showKeys(QWidget* window);

}  // namespace evical::ui
