// Parallel work over a few threads.
#pragma once

#include <cstddef>
#include <functional>

namespace evical {

// Calls work(part) once for every part from 0 to parts - 1, in the caller's thread and at most threads - 1
// others. The first exception is thrown again after all threads have ended; parts that had not begun by then
// are skipped.
void inParallel(int threads, std::size_t parts, const std::function<void(std::size_t part)>& work);

// Lower thread priorities for background work, so that the window stays responsive.

// Lowers the priority of the calling thread and of the threads that it will start. No effect on systems
// without thread priorities (other systems than Linux).
void makeThreadModest();

// Gives the calling thread and those that it will start the lowest priority, for work that nobody waits for.
void makeThreadLast();

}  // namespace evical
