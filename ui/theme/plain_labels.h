// SPDX-License-Identifier: GPL-3.0-or-later
// Labels and tool tips show text from files: names, reasons, paths. Qt's default would show a text with
// markup as rich text, and open the files that it names.
#pragma once

#include <QLabel>

class QApplication;
class QWidget;

namespace evical::ui {

// Makes plain text the default of all labels and tool tips, also of Qt's own dialogs: a label has rich text
// only if its format is set to that.
void showTextAsPlain(QApplication& application);

// The tool tip of this widget is rich text of our own, with names escaped.
void useRichToolTip(QWidget& widget);

// Labels whose text changes many times a second.

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
