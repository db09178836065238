#include "core/base/process_memory.h"

#include <sys/resource.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace evical {

double peakMemory_mb() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0.0;
  constexpr double kBytesPerUnit = 1024.0, kBytesPerMb = 1e6;  // Linux counts in KiB
  return static_cast<double>(usage.ru_maxrss) * kBytesPerUnit / kBytesPerMb;
}

void giveBackFreeMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace evical
