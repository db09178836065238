// Elapsed time by a monotonic clock.
#pragma once

#include <chrono>

namespace evical {

class Stopwatch {
 public:
  // Since construction or the last restart.
  double elapsed_s() const { return secondsFrom(Clock::now() - begin_); }

  // Restarts; returns the elapsed time.
  double restart_s() {
    const Clock::time_point now = Clock::now();
    const double since_s = secondsFrom(now - begin_);
    begin_ = now;
    return since_s;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static double secondsFrom(Clock::duration duration) {
    return std::chrono::duration<double>(duration).count();
  }

  Clock::time_point begin_ = Clock::now();
};

}  // namespace evical
