#!/usr/bin/env bash
# The program without a display: it reports this instead of aborting, and runs commands that need none.
# window_without_display.sh PROGRAM
set -uo pipefail
program=$1
unset DISPLAY WAYLAND_DISPLAY QT_QPA_PLATFORM
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export XDG_CONFIG_HOME=$scratch XDG_DATA_HOME=$scratch

# expect EXIT_CODE TEXT ARGUMENT...
expect() {
  local code=$1 text=$2 said got
  shift 2
  said=$("$program" "$@" 2>&1)
  got=$?
  [ "$got" = "$code" ] && grep -q -e "$text" <<<"$said" && return
  echo "evical-gui $*: exit code $got, not $code with '$text': $said" >&2
  exit 1
}

expect 2 "no display"
expect 2 "no display" session.yaml
QT_QPA_PLATFORM="" expect 2 "no display"
DISPLAY=:9999 QT_QPA_PLATFORM=xcb expect 2 "cannot be opened"
expect 0 "evical 0" --version
expect 0 "--screenshot" --help
expect 2 "no screen dashboard" --screenshot dashboard -o "$scratch/x.png" session.yaml
expect 1 "session.yaml" --screenshot result -o "$scratch/x.png" "$scratch/session.yaml"
