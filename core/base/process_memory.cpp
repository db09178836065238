#include "core/base/process_memory.h"

#include <sys/resource.h>

#include <cstddef>

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

void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kLargestBlock_bytes = 1 << 30, kKept_bytes = 1 << 29;
  mallopt(M_ARENA_MAX, 2);  // otherwise memory freed by a thread is not reused by others
  mallopt(M_MMAP_THRESHOLD, kLargestBlock_bytes);
  mallopt(M_TRIM_THRESHOLD, kKept_bytes);
#endif
}

void giveBackFreeMemory() {
#ifdef __GLIBC__
  constexpr std::size_t kWorthIt_bytes = 1 << 26;
  if (mallinfo2().fordblks > kWorthIt_bytes)
    malloc_trim(0);  // interrupts the other processors for each block
#endif
}

}  // namespace evical
