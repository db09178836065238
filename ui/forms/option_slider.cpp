// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_slider.h"

#include <QLocale>
#include <QSignalBlocker>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

constexpr int kPositions = 200;
constexpr double kPowersFrom = 50.0;  // ratio of maximum and minimum
constexpr int kDigits = 3;

QString sliderText(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

bool isWhole(const std::string& number) {
  bool is_whole = false;
  QLocale::c().toLongLong(sliderText(number), &is_whole);
  return is_whole;
}

bool isNumber(const std::string& number) {
  bool is_number = false;
  return std::isfinite(QLocale::c().toDouble(sliderText(number), &is_number)) && is_number;
}

}  // namespace

bool OptionSlider::fits(const OptionRow& row) {
  return row.choices.empty() && isNumber(row.minimum) && isNumber(row.maximum);
}

OptionSlider::OptionSlider(const OptionRow& row, QWidget* parent)
    : QSlider(Qt::Horizontal, parent),
      minimum_(QLocale::c().toDouble(sliderText(row.minimum))),
      maximum_(QLocale::c().toDouble(sliderText(row.maximum))),
      whole_(isWhole(row.minimum) && isWhole(row.maximum) && isWhole(row.default_value)),
      powers_(minimum_ > 0.0 && maximum_ > kPowersFrom * minimum_) {
  setRange(0, whole_ ? static_cast<int>(std::min<double>(kPositions, maximum_ - minimum_)) : kPositions);
  setFocusPolicy(Qt::TabFocus);
  connect(this, &QSlider::valueChanged, this, [this](int position) {
    if (isSliderDown()) return emit turning(numberAt(position));
    emit turned(numberAt(position));
  });
  connect(this, &QSlider::sliderReleased, this, [this] { emit turned(numberAt(value())); });
}

void OptionSlider::setShown(const QString& number) {
  const double value = std::clamp(QLocale::c().toDouble(number), minimum_, maximum_);
  const double share = powers_ ? std::log(value / minimum_) / std::log(maximum_ / minimum_)
                               : (value - minimum_) / (maximum_ - minimum_);
  const QSignalBlocker quiet(this);
  setValue(static_cast<int>(std::lround(share * maximum())));
}

QString OptionSlider::numberAt(int position) const {
  const double share = static_cast<double>(position) / maximum();
  const double value =
      powers_ ? minimum_ * std::pow(maximum_ / minimum_, share) : minimum_ + share * (maximum_ - minimum_);
  if (whole_) return QString::number(std::llround(value));
  const QString rounded = QString::number(value, 'g', kDigits);
  const double shown = std::clamp(rounded.toDouble(), minimum_, maximum_);  // rounding may exceed the range
  return QLocale::c().toString(shown, 'g', shown == rounded.toDouble() ? kDigits : 12);
}

void OptionSlider::wheelEvent(QWheelEvent* event) {
  event->ignore();
}

}  // namespace evical::ui
