// Manual pages (man 1): help texts as roff. Independent of CLI11 and Qt, since both programs have a page.
#pragma once

#include <string>
#include <vector>

namespace evical {

// "-o,--output", "FOLDER", the description.
struct ManualEntry {
  std::string names, value, text;
};

// Text with its line breaks, then entries; either may be empty.
struct ManualSection {
  std::string title, text;
  std::vector<ManualEntry> entries;
};

struct ManualPage {
  std::string name, summary, synopsis;
  std::vector<ManualSection> sections;
  std::vector<std::string> see_also;  // other pages' names
};

// Adds a full stop if it is missing.
std::string sentence(std::string text);

// Contains no date, so that the same program gives the same bytes.
std::string manualPage(const ManualPage& page, const std::string& version);

}  // namespace evical
