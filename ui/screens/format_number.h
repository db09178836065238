// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and units formatted for tables.
#pragma once

#include "core/base/number.h"

#include <QChar>
#include <QString>

#include <string>

namespace evical::ui {

inline QString fromCore(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

// "12 022 916", with narrow spaces: a point or a comma between thousands would be read as a decimal one.
inline QString countText(quint64 count) {
  constexpr qsizetype kGroup = 3;
  QString text = QString::number(count);
  for (qsizetype place = text.size() - kGroup; place > 0; place -= kGroup) text.insert(place, QChar(0x202f));
  return text;
}

// "12.345 +- 0.012", to the sigma's second digit; the value alone without a sigma.
inline QString withSigma(double value, double sigma) {
  return fromCore(evical::withSigma(value, sigma, " \u00b1 "));
}

// Unit as people write it: "m/s²" of "m/s^2", nothing of "1".
inline QString unitText(const std::string& unit) {
  if (unit == "1") return {};
  return fromCore(unit).replace("^2", QChar(0xb2)).replace("^3", QChar(0xb3));
}

// "Rotation x" of the key "rotation.x", "Gyroscope bias z" of "gyroscope_bias.z".
inline QString nameOfKey(const std::string& key) {
  QString name = fromCore(key).replace('.', ' ').replace('_', ' ');
  if (!name.isEmpty()) name[0] = name[0].toUpper();
  return name;
}

}  // namespace evical::ui
