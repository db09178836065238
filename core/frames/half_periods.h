// When a blinking light turns: half periods begin where brightening events take over from darkening ones, or the
// other way round.
#pragma once

#include <array>
#include <cstddef>

namespace evical {

class HalfPeriods {
 public:
  static constexpr int kBinsPerPeriod = 16;
  static constexpr int kTurn_bins = 3;

  // Brightening less darkening events of the next bin, a period's sixteenth. True where the light has turned, kTurn_bins
  // before this bin's end: those events are the first of the new half period.
  bool add(double balance);

 private:
  static constexpr std::size_t kSmoothed = 5;  // bins

  std::array<double, kSmoothed> last_{};
  std::array<double, 2 * kBinsPerPeriod> heights_{};  // of two periods
  std::size_t count_ = 0;
  int sign_ = 0;
};

}  // namespace evical
