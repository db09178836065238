#!/usr/bin/env bash
# Renders the pictures of README and documentation site from the demo recording. Needs no display. With a folder as
# argument, it writes every screen there, light and dark.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${EVICAL_BUILD:-build/release}
demo=${TMPDIR:-/tmp}/evical/demo # visible in pictures

[ -x "$build/evical-gui" ] || { echo "Build it first: packaging/run.sh" >&2; exit 1; }
[ -f "$demo/truth.yaml" ] || "$build/evical" simulate config/scenarios/davis346_10s.yaml -o "$demo" --quiet
# Two more recordings of the same rig, for the pages that compare.
for seed in 2 3; do
  more=$demo/recording_$seed
  [ ! -f "$more/truth.yaml" ] || continue
  printf 'base: %s/config/scenarios/davis346_10s.yaml\nseed: %s\n' "$PWD" "$seed" > "$demo/recording_$seed.yaml"
  "$build/evical" simulate "$demo/recording_$seed.yaml" -o "$more" --quiet
done
# A log of two IMUs, for the page without a board.
moved=$demo/moved
[ -f "$moved/truth.yaml" ] || "$build/evical" simulate config/scenarios/maintain/step_lever.yaml -o "$moved" --quiet
shown="start-light print-board-light how-to-record-light check-light recording-light detection-dark trajectory-light
       convergence-light signals-light residuals-light result-light export-light lens-light"
pictures=docs/pictures
if [ $# -gt 0 ]; then
  pictures=$1 shown=
  for screen in start print-board how-to-record check recording detection trajectory convergence signals residuals result export lens check-result repeat maintain maintain-over-time; do
    shown+=" $screen-light $screen-dark"
  done
fi
mkdir -p "$pictures"
export QT_QPA_PLATFORM=offscreen # even with a display: the same pictures everywhere
# Runs and settings of the user must not appear in them.
XDG_CONFIG_HOME=$(mktemp -d)
XDG_DATA_HOME=$XDG_CONFIG_HOME
export XDG_CONFIG_HOME XDG_DATA_HOME
trap 'rm -rf "$XDG_CONFIG_HOME"' EXIT
# A camera alone, for the result of a lens.
sed -e '/^imus:/,$d' -e '/^    intrinsics:/,$d' "$demo/session.yaml" > "$demo/camera.yaml"
for picture in $shown; do
  screen=${picture%-*} session=$demo/session.yaml
  further=()
  case $screen in
    check-result) further=("$demo/recording_2/session.yaml") ;;
    maintain*) session=$moved/recording.bag further=("$moved/calibration") ;;
    repeat) further=("$demo/recording_2/session.yaml" "$demo/recording_3/session.yaml") ;;
  esac
  [ "$screen" != lens ] || { screen=result session=$demo/camera.yaml; }
  "$build/evical-gui" --screenshot "$screen" -o "$pictures/$picture.png" --appearance "${picture##*-}" "$session" "${further[@]}"
  # A palette reduces the size to a third without a visible difference.
  convert "$pictures/$picture.png" +dither -colors 256 -strip -define png:compression-level=9 "PNG8:$pictures/$picture.small.png"
  mv "$pictures/$picture.small.png" "$pictures/$picture.png"
done
echo "Pictures are in $pictures"
