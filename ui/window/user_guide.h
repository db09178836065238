// SPDX-License-Identifier: GPL-3.0-or-later
// F1: dialog with the embedded guide and its contents. "?": its last part, the keys.
#pragma once

class QWidget;

namespace evical::ui {

// Raised if already open.
void showUserGuide(QWidget* window);
void showKeys(QWidget* window);

}  // namespace evical::ui
