// Times are integer nanoseconds in files and streams, and seconds since the recording's start in the
// estimator.
#pragma once

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

}  // namespace evical
