// Manual pages (man 1): what help says, as roff. Knows neither CLI11 nor Qt, since both programs have a page.
#pragma once

#include <string>
#include <vector>

namespace evical {

// "-o,--output", "FOLDER", what it is for.
struct ManualEntry {
  std::string names, value, text;
};

// Text, whose lines stay lines, then entries; either may be empty.
struct ManualSection {
  std::string title, text;
  std::vector<ManualEntry> entries;
};

struct ManualPage {
  std::string name, summary, synopsis;
  std::vector<ManualSection> sections;
  std::vector<std::string> see_also;  // other pages' names
};

// Ended by a full stop, if it is none yet.
std::string sentence(std::string text);

// The page without a date: the same program gives the same bytes.
std::string manualPage(const ManualPage& page, const std::string& version);

}  // namespace evical
