// For work beside a window: whoever looks at it goes first where both want the processor.
#pragma once

namespace evical {

// Lowers the priority of the calling thread and of those that it will start. Does nothing where the system
// has no priorities of threads (other systems than Linux).
void makeThreadModest();

// The same for work that nobody waits for: it goes after all other work.
void makeThreadLast();

}  // namespace evical
