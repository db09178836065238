#include "tests/support/test_program.h"

#ifdef EVICAL_TEST_WITH_WINDOWS
#include <QApplication>
using Application = QApplication;
#else
#include <QCoreApplication>
using Application = QCoreApplication;
#endif

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

namespace evical::test_program {
namespace {

std::map<std::string, TestRunner>& runners() {
  static std::map<std::string, TestRunner> all;
  return all;
}

}  // namespace

TestRegistration::TestRegistration(const char* source, TestRunner runner) {
  const std::string name = std::filesystem::path(source).stem().string();
  if (!runners().emplace(name, runner).second) qFatal("two tests are called %s", name.c_str());
}

}  // namespace evical::test_program

int main(int argc, char** argv) {
  using evical::test_program::runners;
  const auto asked = argc > 1 ? runners().find(argv[1]) : runners().end();
  if (asked == runners().end()) {
    std::fprintf(stderr, "Say which test is to run:\n");
    for (const auto& [name, runner] : runners()) std::fprintf(stderr, "  %s\n", name.c_str());
    return 2;
  }
  argv[1] = argv[0];  // the test's own arguments follow its name
  const Application application(--argc, ++argv);
  QTEST_SET_MAIN_SOURCE_PATH
  return asked->second(argc, argv);
}
