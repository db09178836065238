// By how much sums of noise are wider than those of white noise, where noise has a memory: a mount that shakes, an engine.
// docs/maths.md, 15.4.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace evical {

// Of sums over n windows: settled - lost / n, which noise of a short memory follows from its memory on.
struct NoiseAutocorrelation {
  double settled = 1.0, lost = 0.0;
  double freedom = 1e9;  // of the squares that it is made of

  double of(std::size_t windows) const;
  double ofMany() const;
  // What chi squared with so many numbers is above as rarely as white noise is above `white`: higher for the colour, and
  // where there is one, for what is not known of it.
  double limit(double white, Eigen::Index numbers, double wider) const;
};

// How far n windows are from the `before` windows in front of them, in units that make it chi squared with its dimension if
// noise is white and nothing changes.
class ColourStatistics {
 public:
  static constexpr std::array<std::size_t, 7> kLengths = {1, 2, 3, 4, 6, 8, 10};  // n

  ColourStatistics(int dimension, std::size_t before) : dimension_(dimension), before_(before) {}

  void add(std::size_t length_index, double statistic) { values_.at(length_index).push_back(statistic); }
  // By medians, which a few changes do not move; white where there are too few to tell.
  NoiseAutocorrelation colour() const;

 private:
  int dimension_;
  std::size_t before_;
  std::array<std::vector<double>, kLengths.size()> values_;
};

}  // namespace evical
