// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and words as tables show them.
#pragma once

#include "ui/screens/result/result_parameters.h"

namespace evical::ui {

inline QString fromCore(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

// "12.345 +- 0.012": to the sigma's second digit; the value alone where it has none.
inline QString withSigma(double value, double sigma) {
  ParameterRow row;
  row.value = value;
  row.sigma = sigma;
  if (!(sigma > 0.0)) return row.valueText();
  return QString("%1 %2 %3").arg(row.valueText(), QChar(0xb1), row.sigmaText());
}

}  // namespace evical::ui
