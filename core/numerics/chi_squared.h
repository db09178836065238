// Quantiles of sums of squares.
#pragma once

namespace evical {

// For a sum of `count` squares of independent standard normal numbers: the probability that it exceeds
// `value`, and the value that it exceeds with this probability.
double chiSquaredTail(double value, int count);
double chiSquaredLimit(double probability, int count);

// The value that a standard normal number exceeds with this probability.
double normalLimit(double probability);

}  // namespace evical
