// Excess variance of sums of correlated noise over white noise, for example with a mount that shakes, or an
// engine. docs/maths.md, 15.4.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace evical {

// Variance ratio for sums over n windows: settled - lost / n, which is valid beyond the noise's correlation
// time.
struct NoiseAutocorrelation {
  double settled = 1.0, lost = 0.0;
  double freedom = 1e9;  // degrees of freedom of the estimate

  double of(std::size_t windows) const;
  double ofMany() const;
  // Limit of chi squared with this many numbers, with the probability that white noise has for `white`:
  // increased for the correlation of noise, and for the uncertainty of that correlation.
  double limit(double white, Eigen::Index numbers, double wider) const;
};

// Statistics of the differences between n windows and the `before` windows in front of them, in units that
// make them chi squared with the given dimension for white noise without changes.
class ColourStatistics {
 public:
  static constexpr std::array<std::size_t, 7> kLengths = {1, 2, 3, 4, 6, 8, 10};  // n

  ColourStatistics(int dimension, std::size_t before) : dimension_(dimension), before_(before) {}

  void add(std::size_t length_index, double statistic) { values_.at(length_index).push_back(statistic); }
  // From medians, which a few changes do not affect; white if there are too few values.
  NoiseAutocorrelation colour() const;

 private:
  int dimension_;
  std::size_t before_;
  std::array<std::vector<double>, kLengths.size()> values_;
};

}  // namespace evical
