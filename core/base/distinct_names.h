// Names for result folders, from the paths of their inputs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace evical {

// Only letters, digits, '-', '_' and '.'; neither empty nor dots alone.
std::string fitForFolder(std::string name);

// One unique folder per name: the name itself, if it stays within the folder that contains it.
std::vector<std::string> foldersOfNames(std::span<const std::string> names);

// One unique name per path: file names, or names of the folders if these are more specific
// ("left/recording.bag" and "right/recording.bag"), with numbers if neither is unique.
std::vector<std::string> distinctNames(std::span<const std::filesystem::path> paths);

}  // namespace evical
