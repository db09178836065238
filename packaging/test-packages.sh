#!/usr/bin/env bash
# Tests the Debian packages: builds them twice in different folders and compares the bytes, runs lintian, then installs, uses, removes
# and purges them in a bare Debian 12 (packaging/debian/try_in_root.sh). Needs mmdebstrap and some 2 GB in TMPDIR. Takes at least half an
# hour, since the second build does not use ccache (with EVICAL_WARM=1 it does). EVICAL_MIRROR is the mirror of Debian's packages, by
# default this machine's.
set -euo pipefail
cd "$(dirname "$0")/.."

need() { # PROGRAM PACKAGE
  command -v "$1" >/dev/null || { echo "$1 is missing: apt-get install $2" >&2; exit 1; }
}
need mmdebstrap mmdebstrap
need lintian lintian
need git git
# First mirror of this machine that has this release.
# shellcheck disable=SC2016  # apt expands $(...), not the shell
mirror=${EVICAL_MIRROR:-$(apt-get indextargets --format '$(RELEASE) $(REPO_URI)' 2>/dev/null | awk '$1 == "bookworm" { print $2; exit }')}
[ -n "$mirror" ] || { echo "This machine's apt has no mirror of Debian 12 (bookworm): set EVICAL_MIRROR" >&2; exit 1; }

umask 022
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

packaging/packages.sh
packages=$PWD/build/package/packages

echo "Second build"
second=$scratch/at/another/place
mkdir -p "$second"
# With .git: the desktop program shows the commit of its build.
(git ls-files -z && printf '.git\0') | tar --null --files-from=- -c | tar -x -C "$second"
(
  cd "$second"
  [ -n "${EVICAL_WARM:-}" ] || export CCACHE_DISABLE=1
  cmake --preset package >/dev/null
  cmake --build --preset package >/dev/null
  cd build/package && cpack >/dev/null
)
for package in "$packages"/*.deb; do
  cmp "$package" "$second/build/package/packages/$(basename "$package")" ||
    { echo "Two builds of $(basename "$package") differ" >&2; exit 1; }
done
echo "Two builds gave the same bytes."

lintian --fail-on error,warning "$packages"/*.deb
echo "lintian has no complaints."

mkdir "$scratch/in"
cp -r "$packages" examples packaging/debian/try_in_root.sh "$scratch/in"
# shellcheck disable=SC2016
in_root='chroot "$1" sh /srv/in/try_in_root.sh'
mmdebstrap --variant=minbase --include=ca-certificates --aptopt='Acquire::Check-Valid-Until "false"' \
  --customize-hook="copy-in $scratch/in /srv" \
  --customize-hook="$in_root" \
  --format=null bookworm /dev/null "$mirror"
