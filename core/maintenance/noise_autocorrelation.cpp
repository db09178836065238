#include "core/maintenance/noise_autocorrelation.h"

#include "core/numerics/chi_squared.h"
#include "core/numerics/robust.h"

#include <algorithm>

namespace evical {
namespace {

// Replaces 1 / n if a mean of n is compared with one of the m before it: for sums with variances n A - B, the
// B terms of both and of their correlation, over 1 / n + 1 / m.
double lostShare(double n, double m) {
  return (1.0 / (n * n) + 1.0 / (m * m) + 1.0 / (n * m)) / (1.0 / n + 1.0 / m);
}

}  // namespace

double NoiseAutocorrelation::of(std::size_t windows) const {
  return std::max(1.0, settled - lost / static_cast<double>(windows));
}

double NoiseAutocorrelation::ofMany() const {
  return std::max(1.0, settled);
}

// Chi squared with an estimated variance follows Fisher's distribution: its quantiles to first order in 1 /
// freedom.
double NoiseAutocorrelation::limit(double white, Eigen::Index numbers, double wider) const {
  const double estimated = 1.0 - 1.0 / wider;
  const double further = (white + 2.0 - static_cast<double>(numbers)) / (2.0 * freedom);
  return wider * white * (1.0 + estimated * std::max(0.0, further));
}

// Weighted least squares fit to the medians; for n windows, one n-th of the values are independent.
NoiseAutocorrelation ColourStatistics::colour() const {
  constexpr std::size_t kFewest = 12;
  constexpr double kShare =
      0.2;  // of the windows: degrees of freedom, reduced by the scatter of medians and by extrapolation
  const double by_chance = chiSquaredLimit(0.5, dimension_);
  double weights = 0.0, x = 0.0, xx = 0.0, y = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < kLengths.size(); ++k) {
    if (values_[k].size() < kFewest) continue;
    const auto n = static_cast<double>(kLengths[k]);
    const double weight = 1.0 / n, share = lostShare(n, static_cast<double>(before_)),
                 wider = medianOf(values_[k]) / by_chance;
    weights += weight;
    x += weight * share;
    xx += weight * share * share;
    y += weight * wider;
    xy += weight * share * wider;
  }
  const double spread = weights * xx - x * x;
  if (!(spread > 1e-9)) return {};
  const double slope = (weights * xy - x * y) / spread;
  return {(y - slope * x) / weights, -slope, kShare * static_cast<double>(values_.front().size())};
}

}  // namespace evical
