// Folders of the project's own files that tests read, and of pictures that tests write. These are functions,
// not compiler macros: otherwise every test would be recompiled in another checkout, even with ccache.
#pragma once

#include <string>

namespace evical::test {

// `below`: relative to the project's root.
std::string sourcePath(const std::string& below);
// `below`: relative to the build folder.
std::string buildPath(const std::string& below);
// `name`: below config/scenarios, without extension.
std::string scenarioPath(const std::string& name);

}  // namespace evical::test
