// SPDX-License-Identifier: GPL-3.0-or-later
// Input field for one number, in plain or scientific notation. Invalid input is replaced by the current
// value, with a mark that gives the reason.
#pragma once

#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QLocale>

#include <optional>

namespace evical::ui {

// A typed number, finite, with a decimal point or comma; otherwise why it is none.
struct TypedNumber {
  std::optional<double> value;
  QString problem = {};
};
TypedNumber typedNumber(const QString& text);

// "1,300": the comma may be a decimal one, or that of thousands. Not a number.
bool hasAmbiguousComma(const QString& text);

class NumberField : public QLineEdit {
  Q_OBJECT

 public:
  NumberField(double minimum, double maximum, QWidget* parent = nullptr);

  void setValue(double value);  // does not signal
  double value() const { return value_; }
  bool hasRefused() const;  // the last input

 signals:
  void valueEdited(double value);  // by the user, within the range, and different

 protected:
  void focusOutEvent(QFocusEvent* event) override;

 private:
  void take();
  void refuse(const QString& why);

  double minimum_, maximum_, value_ = 0.0;
  QAction* refused_;  // mark of refused input
};

// Spin box with a decimal point in every country: all other numbers of the window have one.
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
