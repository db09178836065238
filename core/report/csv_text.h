// Words in CSV.
#pragma once

#include <string>

namespace evical {

// Names may hold commas and quotes; lines of their own they don't get.
std::string quotedCsv(const std::string& text);

}  // namespace evical
