// A folder's tests in one program: each source registers its test class, and the program runs the one with
// the given source name, followed by Qt Test's own arguments: `test_core_geometry tst_so3_spline -v2`.
#pragma once

#include <QtTest>

namespace evical::test_program {

using TestRunner = int (*)(int argc, char** argv);

// `source`: the test's file; its name without folder and extension is the test's name.
struct TestRegistration {
  TestRegistration(const char* source, TestRunner runner);
};

}  // namespace evical::test_program

#define EVICAL_TEST(Class)                                                   \
  static const evical::test_program::TestRegistration registrationOf##Class( \
      __FILE__, [](int argc, char** argv) {                                  \
        Class test;                                                          \
        return QTest::qExec(&test, argc, argv);                              \
      });
