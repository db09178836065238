// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of a page: they work wherever in the window the focus is, while the page is in view. Fields that are typed in
// keep the keys that they need, and Space presses the button that was reached by Tab.
#pragma once

#include <QKeySequence>

#include <functional>

class QWidget;

namespace evical::ui {

void addPageKey(QWidget* page, const QKeySequence& key, std::function<void()> act);

// Buttons of the page no longer take the focus by a click, after which Space would press them again.
void leaveFocusToKeys(QWidget* page);

}  // namespace evical::ui
