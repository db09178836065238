// SPDX-License-Identifier: GPL-3.0-or-later
// Spin box with a decimal point in every country: all other numbers of the window have one.
#pragma once

#include "ui/forms/number_field.h"

#include <QDoubleSpinBox>
#include <QLocale>

namespace evical::ui {

class DecimalBox final : public QDoubleSpinBox {
 public:
  explicit DecimalBox(QWidget* parent = nullptr) : QDoubleSpinBox(parent) { setLocale(QLocale::c()); }

 protected:
  // A typed comma becomes a point at once. A pasted "1,300" is refused.
  QValidator::State validate(QString& text, int& position) const override {
    QString number = text;
    if (hasAmbiguousComma(number.remove(suffix()))) return QValidator::Invalid;
    text.replace(',', '.');
    return QDoubleSpinBox::validate(text, position);
  }
};

}  // namespace evical::ui
