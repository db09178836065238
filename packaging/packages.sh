#!/usr/bin/env bash
# Makes the Debian packages evical, evical-gui, libevical-dev (and python3-evical, where the build has it) in build/package/packages.
# The same sources give the same bytes, wherever they are built.
set -euo pipefail
cd "$(dirname "$0")/.."

packaging/install-dependencies.sh run package
cmake --preset package
cmake --build --preset package
rm -rf build/package/packages
umask 022
(cd build/package && cpack)
ls -l build/package/packages/*.deb
