// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of core in the words of the forms: they have labels and millimetres, a session file has keys and
// metres.
#pragma once

#include <QLabel>
#include <QString>

namespace evical::ui {

// "board.spacing_m: 0.05" becomes "spacing 50 mm", "spacing 0.05 m" becomes "spacing 50 mm".
QString inFormWords(QString text);

// Label with wrapped text for a form with rows that are hidden at times.

// Its height does not depend on its width: if it did, QFormLayout of Qt 6.4 would write beyond its arrays
// when a row is hidden. The role is one of the style sheet, or empty.
class FormLabel final : public QLabel {
 public:
  FormLabel(const QString& text, const char* role, QWidget* parent) : QLabel(text, parent) {
    setProperty("role", role);
    setWordWrap(true);
  }
  bool hasHeightForWidth() const override { return false; }
};

}  // namespace evical::ui
