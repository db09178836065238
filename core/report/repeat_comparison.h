// Comparison of one recording of a repeat with another one, or with the joint solution.
#pragma once

#include "core/data/assessment.h"

#include <cstddef>
#include <optional>

namespace evical {

// Column of Repeatability; this value means the joint solution of all that fit.
inline constexpr std::size_t kAllTogether = static_cast<std::size_t>(-1);

// Absent if this recording does not determine the number.
std::optional<ValueWithSigma> numberOf(const RepeatedNumber& number, std::size_t column);

// `b` minus `a`. Both sigmas include the priors that all recordings have in common, so the difference's sigma
// is too large rather than too small. The joint solution includes the data of a recording that fits, which do
// not contribute to the difference.
std::optional<ValueWithSigma> differenceOf(const Repeatability& repeat, const RepeatedNumber& number,
                                           std::size_t a, std::size_t b);

}  // namespace evical
