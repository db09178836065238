#!/usr/bin/env bash
# The window as users see it: shown under Xvfb, clicked with xdotool, and inspected. Exit code 77 (skipped)
# without the tools.
# window_under_xvfb.sh PROGRAM SESSION PICTURE_FOLDER
set -euo pipefail
. "$(dirname "$0")/../support/xvfb.sh"
program=$1 session=$2 pictures=$3
for tool in Xvfb xdotool import; do
  command -v "$tool" >/dev/null || { echo "$tool is not installed" >&2; exit 77; }
done
mkdir -p "$pictures"
scratch=$(mktemp -d)
finish() {
  kill "${program_pid:-}" 2>/dev/null || true
  stopDisplay
  rm -rf "$scratch"
}
trap finish EXIT

startDisplay 1280x800

"$program" "$session" 2>"$scratch/errors" &
program_pid=$!
window=$(timeout 60 xdotool search --sync --onlyvisible --name Evical | head -1)
xdotool windowmove "$window" 0 0 windowsize "$window" 1280 800
sleep 1

page=1060x690+216+75 # the area that changes with the page
picture() { import -window root -crop "$page" +repage "$pictures/xvfb-$1.png"; }
differing() { compare -metric AE "$pictures/xvfb-$1.png" "$pictures/xvfb-$2.png" null: 2>&1 || true; }
click() { xdotool mousemove "$1" "$2" click 1; sleep 1; }
fail() { echo "$1" >&2; cat "$scratch/errors" >&2; exit 1; }

click 60 364 # Result, empty
picture empty
click 282 47 # Calibrate
for _ in $(seq 90); do
  sleep 1
  kill -0 "$program_pid" 2>/dev/null || fail "The program has ended unexpectedly."
  picture result
  changed=$(differing empty result)
  [ "${changed%%.*}" -gt 20000 ] && break
done
[ "${changed%%.*}" -gt 20000 ] || fail "No result is shown: $changed pixels differ from the empty screen."
click 70 240 # Trajectory
sleep 2
picture trajectory
changed=$(differing result trajectory)
[ "${changed%%.*}" -gt 20000 ] || fail "No trajectory is shown: $changed pixels differ from the result."

xdotool key --window "$window" ctrl+q 2>/dev/null || true # the window may close before the key is released
for _ in $(seq 100); do kill -0 "$program_pid" 2>/dev/null || break; sleep 0.1; done
wait "$program_pid" || fail "The program ended with code $?."
program_pid=
echo "Opened, calibrated, inspected and closed; pictures are in $pictures"
