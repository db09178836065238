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

// Names of the pictures, by their extensions, in their natural order; empty if the folder cannot be read.
std::vector<std::string> pictureNames(const std::filesystem::path& folder);

// Names of the folders in a folder, in their natural order; without hidden ones.
std::vector<std::string> folderNames(const std::filesystem::path& folder);

// Digits of a name that consists of digits up to its extension; 12 or more are ns, fewer are a count.
std::optional<std::int64_t> timeInName(std::string_view name);

// True if a name in a list is within the list's folder.
bool staysInside(const std::filesystem::path& name);

}  // namespace evical::pictures
