// SPDX-License-Identifier: GPL-3.0-or-later
// Labels whose text changes many times a second.
#pragma once

#include <QLabel>

namespace evical::ui {

// As large as its longest text asks for, whatever it says: a label that asks for another size has everything around it
// laid out anew.
inline void keepSize(QLabel& label, const QString& longest) {
  const QString text = label.text();
  label.setText(longest);
  label.ensurePolished();
  label.setFixedSize(label.sizeHint());
  label.setText(text);
}

}  // namespace evical::ui
