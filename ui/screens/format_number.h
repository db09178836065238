// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and units formatted for tables.
#pragma once

#include "core/base/number.h"

#include <QString>

#include <string>

namespace evical::ui {

inline QString fromCore(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

// "12.345 +- 0.012", to the sigma's second digit; the value alone without a sigma.
inline QString withSigma(double value, double sigma) {
  return fromCore(evical::withSigma(value, sigma, " \u00b1 "));
}

}  // namespace evical::ui
