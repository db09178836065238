// Times are integer nanoseconds in files and streams, and seconds since the recording's start in the
// estimator.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace evical {

inline constexpr double kNanosecondsPerSecond = 1e9;
inline constexpr std::int64_t kMicrosecond_ns = 1000, kSecond_ns = 1'000'000'000;

// Largest distance of a time from its epoch: 146 years. Readers discard other times as damaged, so that
// differences of two times cannot overflow.
inline constexpr std::int64_t kLatestTime_ns = (std::int64_t{1} << 62) - 1;
inline bool isTime(std::int64_t time_ns) {
  return time_ns >= -kLatestTime_ns && time_ns <= kLatestTime_ns;
}

inline double secondsSince(std::int64_t start_ns, std::int64_t time_ns) {
  return static_cast<double>(time_ns - start_ns) / kNanosecondsPerSecond;
}

inline std::int64_t nanosecondsFrom(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * kNanosecondsPerSecond));
}

// In us; halves are rounded up.
constexpr std::int64_t nearestMicrosecond(std::int64_t time_ns) {
  const std::int64_t floor_us = time_ns / kMicrosecond_ns - (time_ns % kMicrosecond_ns < 0 ? 1 : 0);
  return floor_us + (time_ns - floor_us * kMicrosecond_ns >= kMicrosecond_ns / 2 ? 1 : 0);
}

// Elapsed time by a monotonic clock.
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
