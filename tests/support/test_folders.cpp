#include "tests/support/test_folders.h"

namespace evical::test {

std::string sourcePath(const std::string& below) {
  return EVICAL_SOURCE_DIR "/" + below;
}
std::string buildPath(const std::string& below) {
  return EVICAL_BUILD_DIR "/" + below;
}
std::string scenarioPath(const std::string& name) {
  return sourcePath("config/scenarios/" + name + ".yaml");
}

}  // namespace evical::test
