#!/usr/bin/env bash
# Runs the tests that need an otherwise idle machine, one after the other: the desktop program must respond, draw and cancel fast enough, and
# no stage of a calibration may have become slower. All other tests can run in parallel. The argument is a test preset,
# ci by default.
set -euo pipefail
cd "$(dirname "$0")/.."
ctest --preset "${1:-ci}" -L realtime -j1
