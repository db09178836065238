#!/usr/bin/env bash
# The stories in windows that a window manager shows, moves and focuses, with a meter of stalls.
# Exit code 77 (skipped) without the tools.
# stories_under_xvfb.sh TEST_PROGRAM
set -euo pipefail
. "$(dirname "$0")/../support/xvfb.sh"
program=$1
for tool in Xvfb openbox xdotool; do
  command -v "$tool" >/dev/null || { echo "$tool is not installed" >&2; exit 77; }
done
scratch=$(mktemp -d)
finish() {
  stopDisplay
  rm -rf "$scratch"
}
trap finish EXIT

startDisplay 1600x1000
startWindowManager
"$program" tst_stories
