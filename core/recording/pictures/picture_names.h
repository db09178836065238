// Files of pictures in a folder: their list, their order, and the times in their names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::pictures {

// Numbers in names count as numbers: "a9" is before "a10".
bool naturallyBefore(std::string_view a, std::string_view b);

// Names of the pictures, by their extensions, in their natural order; none if the folder cannot be read.
std::vector<std::string> pictureNames(const std::filesystem::path& folder);

// Names of the folders in a folder, in their natural order; without hidden ones.
std::vector<std::string> folderNames(const std::filesystem::path& folder);

// The digits that a name consists of up to its extension; from 12 digits on they are ns, fewer are a count.
std::optional<std::int64_t> timeInName(std::string_view name);

// True if a name in a list stays within the list's folder.
bool staysInside(const std::filesystem::path& name);

}  // namespace evical::pictures
