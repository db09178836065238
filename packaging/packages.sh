#!/usr/bin/env bash
# Builds the Debian packages evical, evical-gui, libevical-dev (and python3-evical, if the build has it) in build/package/packages.
# Builds are reproducible: the same sources give the same bytes in any folder.
set -euo pipefail
cd "$(dirname "$0")/.."

packaging/install-dependencies.sh run package
cmake --fresh --preset package
cmake --build --preset package
rm -rf build/package/packages
umask 022
(cd build/package && cpack)
ls -l build/package/packages/*.deb
