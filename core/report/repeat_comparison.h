// One recording of a repeat beside another one, or beside the solution of all together.
#pragma once

#include "core/data/repeatability.h"

#include <cstddef>
#include <optional>

namespace evical {

// A column of Repeatability, or all that fit together.
inline constexpr std::size_t kAllTogether = static_cast<std::size_t>(-1);

// Nothing where this one does not tell the number.
std::optional<ValueWithSigma> numberOf(const RepeatedNumber& number, std::size_t column);

// `b` minus `a`. What all recordings were told alike counts in both sigmas, so that the difference's is rather too large.
// All together hold what a recording that fits says: what both have in common is no difference.
std::optional<ValueWithSigma> differenceOf(const Repeatability& repeat, const RepeatedNumber& number,
                                           std::size_t a, std::size_t b);

}  // namespace evical
