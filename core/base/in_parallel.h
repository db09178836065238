// Parallel work over a few threads.
#pragma once

#include <cstddef>
#include <functional>

namespace evical {

// Calls work(part) once for every part from 0 to parts - 1, in the caller's thread and at most threads - 1
// others. The first exception is thrown again after all threads have ended; parts that had not begun by then
// are skipped.
void inParallel(int threads, std::size_t parts, const std::function<void(std::size_t part)>& work);

}  // namespace evical
