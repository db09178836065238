// Text in CSV.
#pragma once

#include <string>

namespace evical {

// Quoted text: names may contain commas and quotes; line breaks are replaced.
std::string quotedCsv(const std::string& text);

// Quoted only if the text contains one of these.
std::string csvWord(const std::string& text);

}  // namespace evical
