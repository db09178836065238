// The memory of this process.
#pragma once

namespace evical {

// Peak memory use in MB (10^6 bytes); 0 if the system does not report it.
double peakMemory_mb();

// For programs, at their start: freed memory is used again instead of being returned to the system, which
// takes a tenth of a calibration's time to clear and map it again.
void keepFreedMemory();

// Returns free heap memory to the system. The allocator keeps most of it if used blocks are in between.
void giveBackFreeMemory();

}  // namespace evical
