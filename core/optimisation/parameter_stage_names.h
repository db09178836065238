// What the batch solves for from one stage on, in words for people.
#pragma once

#include "core/optimisation/parameter_blocks.h"

#include <string>
#include <vector>

namespace evical {

// Of quantities that are free, in the order of their table: "camera time offset", once for all cameras.
std::vector<std::string> quantityWords(const std::vector<Quantity>& quantities);

// Of `now` what was not there before.
std::vector<std::string> releasedWords(const std::vector<std::string>& now,
                                       const std::vector<std::string>& before);

}  // namespace evical
