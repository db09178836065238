// Detection of a blinking light's half periods: they begin when ON events start to outweigh OFF events, or
// the other way round.
#pragma once

#include <array>
#include <cstddef>

namespace evical {

class HalfPeriods {
 public:
  static constexpr int kBinsPerPeriod = 16;
  static constexpr int kTurn_bins = 3;

  // Number of ON minus OFF events of the next bin, a sixteenth of a period. True if the light has turned,
  // kTurn_bins before this bin's end: the events since then are the first of the new half period.
  bool add(double balance);

 private:
  static constexpr std::size_t kSmoothed = 5;  // bins

  std::array<double, kSmoothed> last_{};
  std::array<double, 2 * kBinsPerPeriod> heights_{};  // of two periods
  std::size_t count_ = 0;
  int sign_ = 0;
};

}  // namespace evical
