// Time that processors have computed for the caller. Other programs do not lengthen it, waiting neither.
#pragma once

#include <ctime>

namespace evical::test {

inline double clock_s(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
inline double threadCpu_s() {
  return clock_s(CLOCK_THREAD_CPUTIME_ID);
}
inline double processCpu_s() {
  return clock_s(CLOCK_PROCESS_CPUTIME_ID);
}  // of all its threads

}  // namespace evical::test
