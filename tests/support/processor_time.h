// Computing time of the caller. Other programs and waiting do not increase it.
#pragma once

#include <sys/resource.h>

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
// Processor time of all child processes that have ended.
inline double childrenCpu_s() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

}  // namespace evical::test
