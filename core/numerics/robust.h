// Typical values and weights that a few wild errors don't move.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace evical {

// The element in the middle, of an even count the larger of the two there. Reorders [first, last), which must
// not be empty.
template <class Iterator>
auto medianOf(Iterator first, Iterator last) {
  const Iterator middle = first + (last - first) / 2;
  std::nth_element(first, middle, last);
  return *middle;
}

// The same of a list that the caller has no further use for; `of_none` if it is empty.
template <class T>
T medianOf(std::vector<T> values, T of_none = T{}) {
  return values.empty() ? of_none : medianOf(values.begin(), values.end());
}

// A normal number's sigma by the median of its errors' sizes.
inline constexpr double kMadToSigma = 1.4826;

// Cauchy's weight of an error whose square, in units of the scale, this is.
inline double cauchyWeight(double squared_error) {
  return 1.0 / (1.0 + squared_error);
}

inline constexpr double kMedianOfChi2With2 = 1.3862943611198906;  // 2 ln 2

// Ratio of the errors of points to their stated sigmas, by the median of their squared norms in units of
// these. 1 without any.
inline double scaleOfPoints(std::vector<double> squared_errors) {
  return squared_errors.empty() ? 1.0 : std::sqrt(medianOf(std::move(squared_errors)) / kMedianOfChi2With2);
}

}  // namespace evical
