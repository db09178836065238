// Text in CSV.
#pragma once

#include <string>

namespace evical {

// Quoted text: names may contain commas and quotes; line breaks are replaced. A spreadsheet calculates cells that begin with one of
// = + - @: unless they are numbers, they get the mark ' at the beginning, which it shows as text.
std::string quotedCsv(const std::string& text);

// Quoted only if the text contains a comma, a semicolon, a quote or a line break.
std::string csvWord(const std::string& text);

// A cell without that mark.
std::string fromCsv(const std::string& cell);

}  // namespace evical
