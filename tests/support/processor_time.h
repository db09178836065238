// Computing time of the caller. Other programs and waiting do not increase it.
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
