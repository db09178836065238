// Words in CSV.
#pragma once

#include <string>

namespace evical {

// Names may hold commas and quotes; lines of their own they don't get.
std::string quotedCsv(const std::string& text);

// The same only where it holds one of these.
std::string csvWord(const std::string& text);

}  // namespace evical
