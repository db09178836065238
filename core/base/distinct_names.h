// Names for folders of results, from the paths of what they are made of.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace evical {

// Letters, digits, '-', '_' and '.', and neither empty nor dots alone.
std::string fitForFolder(std::string name);

// As many as there are paths, each once: by the files' names, or by those of their folders where these say more
// ("left/recording.bag" beside "right/recording.bag"), with numbers where neither differs.
std::vector<std::string> distinctNames(std::span<const std::filesystem::path> paths);

}  // namespace evical
