// SPDX-License-Identifier: GPL-3.0-or-later
// Labels whose text changes many times a second.
#pragma once

#include <QLabel>

namespace evical::ui {

// Fixes the size to that of the longest text: a label that changes its size triggers a layout of its
// surroundings.
inline void keepSize(QLabel& label, const QString& longest) {
  const QString text = label.text();
  label.setText(longest);
  label.ensurePolished();
  label.setFixedSize(label.sizeHint());
  label.setText(text);
}

}  // namespace evical::ui
