// Picture files in a folder: their list, their order, and the times in their names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::pictures {

// Numbers in names are compared as numbers: "a9" is before "a10".
bool naturallyBefore(std::string_view a, std::string_view b);

// By the extension.
bool isPictureName(const std::filesystem::path& name);

// Names of the pictures, by their extensions, in their natural order; empty if the folder cannot be read.
std::vector<std::string> pictureNames(const std::filesystem::path& folder);

// Names of the folders in a folder, in their natural order; without hidden ones.
std::vector<std::string> folderNames(const std::filesystem::path& folder);

// The longest number of a name without its extension, and the rest: "left" of "left_0012.png".
struct NumberInName {
  std::string_view whole, fraction;  // "1700000000", "050000" of "1700000000.050000.png"
  char separator = 0;                // between both
  std::string rest;
};
NumberInName numberInName(std::string_view name);

// Times of the names, where they have one: ns, us or ms, whichever gives a rate that cameras have; seconds
// with a fraction; or dates. Empty if they are only a count.
struct TimesInNames {
  std::vector<std::optional<std::int64_t>> times_ns;
  std::string note;  // if they are not ns
};
TimesInNames timesInNames(const std::vector<std::string>& names);

// True if a name in a list is within the list's folder.
bool staysInside(const std::filesystem::path& name);

}  // namespace evical::pictures
