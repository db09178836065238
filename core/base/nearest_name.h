// Suggestions for unknown names.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Edit distance: insertions, deletions, substitutions and swaps of neighbours.
int editDistance(std::string_view a, std::string_view b);

// The nearest known name; empty if more than half of its letters differ.
std::string nearestName(std::string_view name, std::span<const std::string> known);

// A sentence for messages: "Did you mean 'rows'?", or the list of known names.
std::string nameAdvice(std::string_view name, std::span<const std::string> known);

// "a, b, c". (fmt::join of strings causes a warning in GCC 12.)
std::string joined(std::span<const std::string> words);

// Names for result folders, from the paths of their inputs.

// Only letters, digits, '-', '_' and '.'; neither empty nor dots alone.
std::string fitForFolder(std::string name);

// One unique folder per name: the name itself, if it stays within the folder that contains it.
std::vector<std::string> foldersOfNames(std::span<const std::string> names);

// One unique name per path: file names, or names of the folders if these are more specific
// ("left/recording.bag" and "right/recording.bag"), with numbers if neither is unique.
std::vector<std::string> distinctNames(std::span<const std::filesystem::path> paths);

}  // namespace evical
