// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/number_field.h"

#include "ui/theme/theme.h"

#include <QAction>
#include <QLocale>
#include <QRegularExpression>
#include <QToolTip>

#include <cmath>

namespace evical::ui {
namespace {

QString numberText(double value) {
  constexpr int kDigits = 12;  // hides rounding errors of unit conversions
  return QLocale::c().toString(value, 'g', kDigits);
}

}  // namespace

bool hasAmbiguousComma(const QString& text) {
  static const QRegularExpression thousands(R"(^\s*[+-]?[1-9]\d{0,2}(,\d{3})+\s*$)");
  return thousands.match(text).hasMatch();
}

TypedNumber typedNumber(const QString& text) {
  const QString typed = text.trimmed();
  if (hasAmbiguousComma(typed))
    return {{},
            QObject::tr("%1 is ambiguous: write a decimal point, and no comma between thousands").arg(typed)};
  bool is_number = false;
  const double value = QLocale::c().toDouble(QString(typed).replace(',', '.'), &is_number);
  if (!is_number || !std::isfinite(value)) return {{}, QObject::tr("%1 is not a number").arg(typed)};
  return {value};
}

NumberField::NumberField(double minimum, double maximum, QWidget* parent)
    : QLineEdit(parent),
      minimum_(minimum),
      maximum_(maximum),
      refused_(addAction(icon("warning", theme().warning), QLineEdit::LeadingPosition)) {
  setAlignment(Qt::AlignRight);
  refused_->setVisible(false);
  connect(this, &QLineEdit::editingFinished, this, &NumberField::take);
}

bool NumberField::hasRefused() const {
  return refused_->isVisible();
}

void NumberField::setValue(double value) {
  value_ = value;
  setText(numberText(value));
  refused_->setVisible(false);
  if (!hasFocus()) setCursorPosition(0);  // a number that is longer than the field shows its start
}

void NumberField::focusOutEvent(QFocusEvent* event) {
  QLineEdit::focusOutEvent(event);
  setCursorPosition(0);
}

void NumberField::take() {
  if (!isModified()) return;
  const auto [value, problem] = typedNumber(text());
  if (!value) return refuse(problem);
  const double typed = *value;
  if (typed < minimum_ || typed > maximum_) {
    return refuse(tr("%1 is not between %2 and %3").arg(text(), numberText(minimum_), numberText(maximum_)));
  }
  const bool other = typed != value_;
  setValue(typed);
  if (other) emit valueEdited(typed);
}

void NumberField::refuse(const QString& why) {
  const QString text = tr("%1. The value is still %2").arg(why, numberText(value_));
  setText(numberText(value_));
  refused_->setToolTip(text);
  refused_->setVisible(true);
  QToolTip::showText(mapToGlobal(rect().bottomLeft()), text, this);
}

}  // namespace evical::ui
