// Lower thread priorities for background work, so that the window stays responsive.
#pragma once

namespace evical {

// Lowers the priority of the calling thread and of the threads that it will start. No effect on systems
// without thread priorities (other systems than Linux).
void makeThreadModest();

// Gives the calling thread and those that it will start the lowest priority, for work that nobody waits for.
void makeThreadLast();

}  // namespace evical
