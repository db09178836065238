// Names for people of the quantities that a stage of the batch releases.
#pragma once

#include "core/optimisation/parameter_blocks.h"

#include <string>
#include <vector>

namespace evical {

// Names of free quantities, in the order of their table: "camera time offset", once for all cameras.
std::vector<std::string> quantityWords(const std::vector<Quantity>& quantities);

// Names of `now` that are not among the earlier ones.
std::vector<std::string> releasedWords(const std::vector<std::string>& now,
                                       const std::vector<std::string>& before);

}  // namespace evical
