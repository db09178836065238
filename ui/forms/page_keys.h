// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of a page: they work with any focus in the window while the page is visible. Input fields keep the
// keys that they need, and Space presses a button that was reached by Tab.
#pragma once

#include <QKeySequence>
#include <QObject>

#include <functional>

class QWidget;

namespace evical::ui {

void addPageKey(QWidget* page, const QKeySequence& key, std::function<void()> act);

// Buttons of the page no longer take the focus when clicked: otherwise Space would press them again.
void leaveFocusToKeys(QWidget* page);

// Ctrl+Z in a text field undoes typing. Without typed text, fields would still consume the key; this filter
// on the application passes it to the window's undo instead.
class SessionUndoKeys : public QObject {
 public:
  using QObject::QObject;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace evical::ui
