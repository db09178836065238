// SPDX-License-Identifier: GPL-3.0-or-later
// Label with wrapped text for a form with rows that are hidden at times.
#pragma once

#include <QLabel>

namespace evical::ui {

// Its height does not depend on its width: if it did, QFormLayout of Qt 6.4 would write beyond its arrays when a
// row is hidden.
class FormLabel final : public QLabel {
 public:
  FormLabel(const QString& text, QWidget* parent) : QLabel(text, parent) { setWordWrap(true); }
  bool hasHeightForWidth() const override { return false; }
};

}  // namespace evical::ui
