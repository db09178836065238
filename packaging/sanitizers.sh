#!/usr/bin/env bash
# Runs the desktop program's tests with the address and undefined-behaviour sanitizers, those of the Python module with the
# address sanitizer, and calibrations in the program's pattern of threads, but without Qt, with the thread sanitizer. Run by
# hand: the build needs 34 min of processor time, and the tests more than an hour on two cores.
# Usage: packaging/sanitizers.sh [asan|tsan]    both without an argument
set -euo pipefail
cd "$(dirname "$0")/.."
which=${1:-both}

packaging/install-dependencies.sh test sanitizers
suppressions=$PWD/packaging/sanitizers

if [ "$which" != tsan ]; then
  cmake --fresh --preset asan
  nice -n 5 cmake --build --preset asan --target ui_tests
  export ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1:strict_string_checks=1
  export LSAN_OPTIONS=suppressions=$suppressions/leaks.txt:print_suppressions=0
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
  export QTEST_FUNCTION_TIMEOUT=3600000 # ms
  ctest --preset asan -L '^ui$' --timeout 3600
  cmake --fresh --preset ci
  cmake --build --preset ci
  ctest --preset ci -R '^python_asan'
fi

if [ "$which" != asan ]; then
  cmake --fresh --preset tsan
  nice -n 5 cmake --build --preset tsan --target tst_job_pattern
  TSAN_OPTIONS=second_deadlock_stack=1:suppressions=$suppressions/races.txt \
    ctest --preset tsan -R '^tst_job_pattern$' --timeout 3600
fi
