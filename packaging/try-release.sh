#!/usr/bin/env bash
# Tests the current commit on another release of Debian, in a temporary root:
# packaging/try-release.sh RELEASE [COMMAND...], e.g. trixie. Without a command it runs packaging/test.sh --all. Needs root and the
# package mmdebstrap. EVICAL_DATA, if set, is available there, too.
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "$#" -eq 0 ]; then
  echo "Name a release: packaging/try-release.sh trixie" >&2
  exit 2
fi
release=$1
shift
[ "$#" -gt 0 ] || set -- packaging/test.sh --all
if ! command -v mmdebstrap >/dev/null; then
  echo "mmdebstrap is missing. Install it as root: apt-get install mmdebstrap" >&2
  exit 1
fi

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
git clone -q . "$scratch/evical"
hooks=(--customize-hook="copy-in $scratch/evical /srv")
data=
if [ -n "${EVICAL_DATA:-}" ]; then
  hooks+=(--customize-hook="mkdir -p \"\$1/srv/data\"" --customize-hook="sync-in $EVICAL_DATA /srv/data")
  data=EVICAL_DATA=/srv/data
fi
command=$(printf '%q ' "$@")
mmdebstrap --variant=minbase --include=ca-certificates,git "${hooks[@]}" \
  --customize-hook="chroot \"\$1\" env HOME=/root LANG=C.UTF-8 $data bash -c 'git config --global --add safe.directory /srv/evical && cd /srv/evical && $command'" \
  --format=null "$release" /dev/null "${EVICAL_MIRROR:-http://deb.debian.org/debian}"
