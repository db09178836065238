// Where the project's own files are that tests read, and where tests leave pictures. Functions, not macros of the compiler's: else
// every test would be compiled anew in another checkout, ccache or not.
#pragma once

#include <string>

namespace evical::test {

// `below`: as seen from the project's root.
std::string sourcePath(const std::string& below);
// `below`: as seen from the build folder.
std::string buildPath(const std::string& below);
// `name`: below config/scenarios, without its ending.
std::string scenarioPath(const std::string& name);

}  // namespace evical::test
