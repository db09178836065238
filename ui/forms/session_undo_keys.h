// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl+Z in a text field undoes typing. Without typed text, fields would still consume the key; this filter
// on the application passes it to the window's undo instead.
#pragma once

#include <QObject>

namespace evical::ui {

class SessionUndoKeys : public QObject {
 public:
  using QObject::QObject;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace evical::ui
