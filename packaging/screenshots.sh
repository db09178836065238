#!/usr/bin/env bash
# Makes the README's pictures: every screen of the program after it has calibrated the demo recording, light and dark.
# Without a display. With a folder as argument the pictures go there.
set -euo pipefail
cd "$(dirname "$0")/.."
pictures=${1:-docs/pictures}
program=build/release/evical-gui
demo=build/screenshots/demo

[ -x "$program" ] || { echo "Build it first: packaging/run.sh" >&2; exit 1; }
[ -f "$demo/truth.yaml" ] || build/release/evical simulate config/scenarios/davis346_10s.yaml -o "$demo" --quiet
mkdir -p "$pictures"
export QT_QPA_PLATFORM=offscreen # also where there is a display: the same pictures everywhere
for screen in recording detection trajectory convergence signals residuals result; do
  for appearance in light dark; do
    "$program" --screenshot "$screen" -o "$pictures/$screen-$appearance.png" --appearance "$appearance" "$demo/session.yaml"
  done
done
echo "Pictures are in $pictures"
