// What processors have done for the thread that asks.
#pragma once

#include <ctime>

namespace evical::test {

inline double threadCpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace evical::test
