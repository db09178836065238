// Robust typical values and weights.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
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

// The square in sigmas of a point's error in two directions that is as probable as this one in one direction.
inline double asOfTwoDirections(double squared_error) {
  constexpr double kSmallest = 1e-300;
  return -2.0 * std::log(std::max(std::erfc(std::sqrt(0.5 * squared_error)), kSmallest));
}

// Ratio of the errors of points to their stated sigmas, from the median of their normalised squared norms. 1
// if there are none.
inline double scaleOfPoints(std::vector<double> squared_errors) {
  return squared_errors.empty() ? 1.0 : std::sqrt(medianOf(std::move(squared_errors)) / kMedianOfChi2With2);
}

// Covariance of a sum of scores that are correlated with their neighbours in time (W. Newey, K. West,
// Econometrica 1987): products of neighbours have weights that fall to zero at a bound.

template <int kSize>
using ScoreVector = Eigen::Matrix<double, kSize, 1>;
template <int kSize>
using ScoreMatrix = Eigen::Matrix<double, kSize, kSize>;

// Scatter of scores at even steps in time: weights fall to zero at `lags` + 1 steps.
template <int kSize>
ScoreMatrix<kSize> neweyWestByLag(const std::vector<ScoreVector<kSize>>& scores, Eigen::Index size,
                                  std::size_t lags) {
  ScoreMatrix<kSize> sum = ScoreMatrix<kSize>::Zero(size, size);
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / (static_cast<double>(lags) + 1.0);
    for (std::size_t i = 0; i + lag < scores.size(); ++i) {
      const ScoreMatrix<kSize> product = scores[i] * scores[i + lag].transpose();
      if (lag == 0) {
        sum += product;
      } else {
        sum += weight * (product + product.transpose());
      }
    }
  }
  return sum;
}

// Scatter of scores at any times: weights fall to zero at `bound_s`; with a bound of zero only products of
// simultaneous scores remain.
template <int kSize>
ScoreMatrix<kSize> neweyWestByTime(std::span<const double> times_s,
                                   const std::vector<ScoreVector<kSize>>& scores, Eigen::Index size,
                                   double bound_s) {
  ScoreMatrix<kSize> sum = ScoreMatrix<kSize>::Zero(size, size);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    for (std::size_t j = 0; j < scores.size(); ++j) {
      const double apart_s = std::abs(times_s[i] - times_s[j]);
      if (apart_s > bound_s) continue;
      const double weight = bound_s > 0.0 ? 1.0 - apart_s / bound_s : 1.0;
      sum += weight * scores[i] * scores[j].transpose();
    }
  }
  return sum;
}

}  // namespace evical
