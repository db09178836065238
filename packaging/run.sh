#!/usr/bin/env bash
# Installs missing packages, builds the command line program, simulates the demo recording, calibrates it, and compares the
# result with the truth. Then builds the desktop program and the Python module, and opens the desktop program on the demo if
# there is a display. An argument names the folder for the demo.
set -euo pipefail
cd "$(dirname "$0")/.."
demo=${1:-demo}
evical=build/release/evical

step() { printf '\n[%d:%02d] %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$1"; }

if [ -x "$evical" ]; then
  echo "Evical: updates the build and calibrates a simulated recording."
else
  echo "Evical: builds, and calibrates a simulated recording. On two cores the first result takes 7 to 10 minutes, all programs 9 to 14, after missing packages are installed."
fi
step "1/5 Installing packages"
packaging/install-dependencies.sh run
step "2/5 Building the command line program"
cmake --fresh --preset release -DEVICAL_TESTS=OFF >/dev/null
cmake --build --preset release --target evical
step "3/5 Simulating a recording with known truth"
if [ ! -f "$demo/session.yaml" ]; then
  "$evical" simulate config/scenarios/davis346.yaml -o "$demo"
fi
step "4/5 Calibrating it, and comparing the result with the truth"
"$evical" calibrate "$demo/session.yaml" -o "$demo/result"
"$evical" compare "$demo/result/result.yaml" "$demo/truth.yaml"
step "5/5 Building the desktop program and the Python module"
cmake --build --preset release

cat <<TEXT

programs    $evical, build/release/evical-gui
recording   $demo/recording.bag, with $demo/session.yaml and $demo/truth.yaml
result      open $demo/result/report.html; next to it result.yaml, trajectory.csv, detections.csv, log.txt
paths       export PATH=$PWD/build/release:\$PATH PYTHONPATH=$PWD/build/release/python
TEXT
step "Done"

if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec build/release/evical-gui "$demo/session.yaml"
fi
