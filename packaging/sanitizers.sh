#!/usr/bin/env bash
# Runs calibrations in the desktop program's pattern of threads, but without Qt, with the thread sanitizer. By hand: it takes
# a quarter of an hour on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

packaging/install-dependencies.sh
cmake --preset tsan
nice -n 5 cmake --build --preset tsan --target tst_job_pattern
TSAN_OPTIONS=second_deadlock_stack=1:suppressions=$PWD/packaging/sanitizers/races.txt \
  ctest --preset tsan -R '^tst_job_pattern$' --timeout 3600
