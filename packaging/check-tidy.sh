#!/usr/bin/env bash
# Fails and lists the places if clang-tidy reports anything in core, app, ui or python:
#   packaging/check-tidy.sh                    all sources
#   packaging/check-tidy.sh SOURCE...          these sources
#   packaging/check-tidy.sh --changed [BASE]   sources that differ from commit BASE, or include a header that differs
# BASE is by default $EVICAL_BASE, or the branch's merge base with its upstream; on a plain clone of main, the state one day before
# the last commit. EVICAL_TIDY_TIMES=1 prints the time of each unit.
set -euo pipefail
cd "$(dirname "$0")/.."

# Other versions have other checks: .clang-tidy is for the version of Debian 12.
version=$(clang-tidy --version | sed -n 's/.*version \([0-9]*\).*/\1/p' | head -1)
if [ "$version" != 14 ]; then
  echo "clang-tidy: not run, since this is version $version, but .clang-tidy is for version 14."
  exit 0
fi

default_base() {
  local base newest
  if [ -n "${EVICAL_BASE:-}" ] && git rev-parse -q --verify "$EVICAL_BASE^{commit}" >/dev/null; then
    echo "$EVICAL_BASE"
    return
  fi
  base=$(git merge-base HEAD '@{upstream}' 2>/dev/null) || base=
  if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then
    newest=$(git log -1 --format=%ct)
    base=$(git rev-list -1 --before=$((newest - 86400)) HEAD)
  fi
  echo "$base"
}

cmake --fresh --preset ci -B build/tidy -DEVICAL_UNITY=OFF >/dev/null
if [ "${1:-}" = --changed ]; then
  base=${2:-$(default_base)}
  if [ -n "$base" ]; then
    echo "clang-tidy: sources that differ from $(git log -1 --format='%h of %cs' "$base")"
    set -- --changed "$base"
  else
    shift "$#"
  fi
fi
exec python3 packaging/tidy_groups.py build/tidy "$@"
