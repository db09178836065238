// Lower thread priorities for background work, so that the window stays responsive.
#pragma once

namespace evical {

// Lowers the priority of the calling thread and of the threads that it will start. No effect on systems
// without thread priorities (other systems than Linux).
void makeThreadModest();

// The same for work that nobody waits for: lowest priority.
void makeThreadLast();

}  // namespace evical
