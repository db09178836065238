// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of a page: they work with any focus in the window while the page is visible. Input fields keep the
// keys that they need, and Space presses a button that was reached by Tab.
#pragma once

#include <QKeySequence>

#include <functional>

class QWidget;

namespace evical::ui {

void addPageKey(QWidget* page, const QKeySequence& key, std::function<void()> act);

// Buttons of the page no longer take the focus when clicked: otherwise Space would press them again.
void leaveFocusToKeys(QWidget* page);

}  // namespace evical::ui
