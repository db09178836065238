// The memory of this process.
#pragma once

namespace evical {

// How much was in use at most, in MB (10^6 bytes); 0 where the system does not say.
double peakMemory_mb();

// To the system goes what is free; by itself little of it does where what is kept lies between.
void giveBackFreeMemory();

}  // namespace evical
