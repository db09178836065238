// Robust typical values and weights.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace evical {

// The median; the upper one for an even count. Reorders [first, last), which must not be empty.
template <class Iterator>
auto medianOf(Iterator first, Iterator last) {
  const Iterator middle = first + (last - first) / 2;
  std::nth_element(first, middle, last);
  return *middle;
}

// The same for a list that may be reordered; `of_none` if it is empty.
template <class T>
T medianOf(std::vector<T> values, T of_none = T{}) {
  return values.empty() ? of_none : medianOf(values.begin(), values.end());
}

// Sigma of a normal distribution from the median of absolute errors.
inline constexpr double kMadToSigma = 1.4826;

// Cauchy weight of an error; the argument is its square in units of the squared scale.
inline double cauchyWeight(double squared_error) {
  return 1.0 / (1.0 + squared_error);
}

inline constexpr double kMedianOfChi2With2 = 1.3862943611198906;  // 2 ln 2

// Ratio of the errors of points to their stated sigmas, from the median of their normalised squared norms. 1
// if there are none.
inline double scaleOfPoints(std::vector<double> squared_errors) {
  return squared_errors.empty() ? 1.0 : std::sqrt(medianOf(std::move(squared_errors)) / kMedianOfChi2With2);
}

}  // namespace evical
