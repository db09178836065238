#!/usr/bin/env bash
# Installs what is missing, builds, simulates the demo recording, calibrates it, and prints the result against the truth.
# Where there is a display, the desktop program then opens on the demo.
# With a folder as argument the demo goes there.
set -euo pipefail
cd "$(dirname "$0")/.."
demo=${1:-demo}

packaging/install-dependencies.sh
cmake --preset release -DEVICAL_TESTS=OFF
cmake --build --preset release
evical=build/release/evical

if [ ! -f "$demo/session.yaml" ]; then
  "$evical" simulate config/scenarios/davis346.yaml -o "$demo"
fi
"$evical" calibrate "$demo/session.yaml" -o "$demo/result"
"$evical" compare "$demo/result/result.yaml" "$demo/truth.yaml"

cat <<TEXT

programs    $evical, build/release/evical-gui
recording   $demo/recording.bag, with $demo/session.yaml and $demo/truth.yaml
result      $demo/result: result.yaml, trajectory.csv, detections.csv, log.txt
TEXT

if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec build/release/evical-gui "$demo/session.yaml"
fi
