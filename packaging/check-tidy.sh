#!/usr/bin/env bash
# Fails and lists the places if clang-tidy reports anything in core, app, ui or python:
#   packaging/check-tidy.sh                    all sources
#   packaging/check-tidy.sh SOURCE...          these sources
#   packaging/check-tidy.sh --changed [BASE]   sources that differ from commit BASE, or include a header that differs
#   packaging/check-tidy.sh --recent           the same for 4 minutes, by default from the state one day before the last commit:
#                                              those that differ come first
# BASE is $EVICAL_BASE, else the branch's merge base with its upstream. packaging/nightly.sh checks all sources.
# EVICAL_TIDY_TIMES=1 prints the time of each unit.
set -euo pipefail
cd "$(dirname "$0")/.."

# Other versions have other checks: .clang-tidy is for the version of Debian 12.
version=$(clang-tidy --version | sed -n 's/.*version \([0-9]*\).*/\1/p' | head -1)
if [ "$version" != 14 ]; then
  echo "clang-tidy: not run, since this is version $version, but .clang-tidy is for version 14."
  exit 0
fi

# $EVICAL_BASE if it is a commit, else the output of this command.
base_or() { # COMMAND...
  if [ -n "${EVICAL_BASE:-}" ] && git rev-parse -q --verify "$EVICAL_BASE^{commit}" >/dev/null; then
    echo "$EVICAL_BASE"
  else
    "$@"
  fi
}
start_of_branch() { git merge-base HEAD '@{upstream}' 2>/dev/null || git rev-parse HEAD; }
a_day_before() { git rev-list -1 --before=$(($(git log -1 --format=%ct) - 86400)) HEAD; }

cmake --fresh --preset ci -B build/tidy -DEVICAL_UNITY=OFF >/dev/null
limit=()
case "${1:-}" in
  --changed) base=${2:-$(base_or start_of_branch)} ;;
  --recent)
    base=$(base_or a_day_before)
    limit=(--limit 240)
    ;;
esac
if [ -n "${base:-}" ]; then
  echo "clang-tidy: sources that differ from $(git log -1 --format='%h of %cs' "$base")"
  set -- --changed "$base" "${limit[@]}"
elif [ "${1:-}" = --recent ]; then # the history is shorter
  set -- "${limit[@]}"
fi
exec python3 packaging/tidy_groups.py build/tidy "$@"
