#!/usr/bin/env bash
# The stories in windows that a window manager shows, moves and focuses, with the meter of how long they stand still.
# Exit code 77 (skipped) without the tools.
#   stories_under_xvfb.sh TEST_PROGRAM
set -euo pipefail
program=$1
for tool in Xvfb openbox xdotool; do
  command -v "$tool" >/dev/null || { echo "$tool is not installed" >&2; exit 77; }
done
scratch=$(mktemp -d)
finish() {
  kill "${manager_pid:-}" "${display_pid:-}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$scratch"
}
trap finish EXIT

Xvfb -displayfd 3 -screen 0 1600x1000x24 -nolisten tcp 3>"$scratch/display" 2>/dev/null &
display_pid=$!
for _ in $(seq 100); do [ -s "$scratch/display" ] && break; sleep 0.1; done
export DISPLAY=":$(cat "$scratch/display")" QT_QPA_PLATFORM=xcb XDG_CONFIG_HOME="$scratch" XDG_DATA_HOME="$scratch" HOME="$scratch"
openbox 2>/dev/null &
manager_pid=$!
# It manages as soon as the root window says who does.
for _ in $(seq 100); do
  xdotool get_desktop >/dev/null 2>&1 && break
  sleep 0.1
done
"$program" tst_stories
