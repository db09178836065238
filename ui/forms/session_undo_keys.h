// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl+Z in a field of text takes back what is being typed. Where nothing is, fields swallow the key all the same; with
// this filter on the application the window's own undo has it then.
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
