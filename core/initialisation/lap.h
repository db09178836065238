// How long steps take.
#pragma once

#include <chrono>

namespace evical {

// Time since it was made or last asked.
class Lap {
 public:
  double next_s() {
    const auto now = Clock::now();
    const double since_s = std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
    return since_s;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace evical
