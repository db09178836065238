// SPDX-License-Identifier: GPL-3.0-or-later
// A quantity over time in bins of the same length.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace evical::ui {

struct RateCurve {
  double begin_s = 0.0, step_s = 0.01;
  std::vector<float> values;  // NaN if unknown

  double end_s() const { return begin_s + step_s * static_cast<double>(values.size()); }
  // Index of the bin that contains a time; values.size() if none does.
  std::size_t binAt(double time_s) const {
    const double bin = std::floor((time_s - begin_s) / step_s);
    return bin >= 0.0 && bin < static_cast<double>(values.size()) ? static_cast<std::size_t>(bin)
                                                                  : values.size();
  }
};

}  // namespace evical::ui
