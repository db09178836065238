#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, runs every test, and checks the sources' format.
set -euo pipefail
cd "$(dirname "$0")/.."

packaging/install-dependencies.sh
cmake --preset ci
cmake --build --preset ci
ctest --preset ci
packaging/check-format.sh
