#include "core/numerics/chi_squared.h"

#include <cmath>
#include <numbers>

namespace evical {
namespace {

constexpr int kHalvings = 200;  // to the precision of double

// Argument at which a falling function has this value.
template <class Falling>
double whereFallingTo(double wanted, double low, double high, const Falling& value) {
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (value(middle) > wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

// Recursion over every other count, by parts: Q(x; n + 2) = Q(x; n) + (x/2)^(n/2) exp(-x/2) / Gamma(n/2 + 1).
double chiSquaredTail(double value, int count) {
  if (!(value > 0.0)) return 1.0;
  const double half = 0.5 * value;
  int n = count % 2 == 0 ? 2 : 1;
  double tail = n == 2 ? std::exp(-half) : std::erfc(std::sqrt(half));
  for (; n < count; n += 2) tail += std::exp(0.5 * n * std::log(half) - half - std::lgamma(0.5 * n + 1.0));
  return tail;
}

double chiSquaredLimit(double probability, int count) {
  constexpr double kLargest = 1e4;  // its tail underflows
  return whereFallingTo(probability, 0.0, kLargest,
                        [&](double value) { return chiSquaredTail(value, count); });
}

double normalLimit(double probability) {
  constexpr double kLargest = 40.0;
  return whereFallingTo(probability, -kLargest, kLargest,
                        [](double value) { return 0.5 * std::erfc(value / std::numbers::sqrt2); });
}

}  // namespace evical
