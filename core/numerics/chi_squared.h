// How large sums of squares get by chance.
#pragma once

namespace evical {

// Of a sum of `count` squares of independent standard normal numbers: how likely it is above `value`, and the value
// that it is above with this probability.
double chiSquaredTail(double value, int count);
double chiSquaredLimit(double probability, int count);

// The value that a standard normal number is above with this probability.
double normalLimit(double probability);

}  // namespace evical
