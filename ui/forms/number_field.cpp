// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/number_field.h"

#include "ui/theme/theme.h"

#include <QLocale>

namespace evical::ui {
namespace {

QString numberText(double value) {
  constexpr int kDigits = 12;  // hides what conversions of units leave behind
  return QLocale::c().toString(value, 'g', kDigits);
}

}  // namespace

NumberField::NumberField(double minimum, double maximum, QWidget* parent)
    : QLineEdit(parent), minimum_(minimum), maximum_(maximum) {
  setAlignment(Qt::AlignRight);
  connect(this, &QLineEdit::editingFinished, this, &NumberField::take);
}

void NumberField::setValue(double value) {
  value_ = value;
  setText(numberText(value));
  showWrong({});
}

void NumberField::take() {
  bool is_number = false;
  const double typed = QLocale::c().toDouble(text().trimmed().replace(',', '.'), &is_number);
  if (!is_number) return showWrong(tr("This is not a number"));
  if (typed < minimum_ || typed > maximum_) {
    return showWrong(tr("Give a number from %1 to %2").arg(numberText(minimum_), numberText(maximum_)));
  }
  showWrong({});
  if (typed == value_) return;
  value_ = typed;
  emit valueEdited(typed);
}

void NumberField::showWrong(const QString& why) {
  if (!wrong_) help_ = toolTip();
  wrong_ = !why.isEmpty();
  setToolTip(wrong_ ? why : help_);
  QPalette colours;
  if (wrong_) colours.setColor(QPalette::Text, theme().bad);
  setPalette(colours);
}

}  // namespace evical::ui
