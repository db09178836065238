#!/usr/bin/env bash
# Installs what is missing, checks the sources' format, builds with warnings as errors, runs clang-tidy and every
# test. Prints at its end how long each of these took.
set -euo pipefail
cd "$(dirname "$0")/.."

times=()
step() { # NAME COMMAND...
  local name=$1 begin=$SECONDS code=0
  shift
  "$@" || code=$?
  times+=("$(printf '%-20s %5d s' "$name" $((SECONDS - begin)))")
  [ "$code" -eq 0 ] || failed+=("$name")
  return "$code"
}
failed=()
summary() {
  printf '\n'
  [ "${#times[@]}" -eq 0 ] || printf '%s\n' "${times[@]}"
  printf '%-20s %5d s\n' "all of it" "$SECONDS"
  [ "${#failed[@]}" -eq 0 ] || printf 'Failed: %s\n' "${failed[*]}"
}
trap summary EXIT

step install packaging/install-dependencies.sh
step format packaging/check-format.sh
step configure cmake --preset ci
step build cmake --build --preset ci
step clang-tidy packaging/check-tidy.sh
step tests ctest --preset ci
# What stages of a calibration cost against reading its events.
cat build/ci/speed_guard.txt 2>/dev/null || true
