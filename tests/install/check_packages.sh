#!/usr/bin/env bash
# The packages of this build: reproducible bytes, contents, no complaints of lintian and AppStream, and a
# command line that calibrates from the unpacked package. packaging/test-packages.sh tests them on a bare
# machine.
# check_packages.sh BUILD SCRATCH RECORDING GUI PYTHON
set -euo pipefail
build=$1 scratch=$2 recording=$3 gui=$4 python=$5
export LC_ALL=C.UTF-8

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
# Compressed with gzip, which takes a tenth of the time of the packages' xz.
pack() { # FOLDER
  rm -rf "${1:?}"
  mkdir -p "$1"
  (cd "$1" && cpack -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip --config "$build/CPackConfig.cmake" -B "$1") >"$1.log" 2>&1
}
umask 022
rm -rf "${scratch:?}"
mkdir -p "$scratch"
pack "$scratch/first" || { cat "$scratch/first.log"; fail "cpack"; }
# Times are the changelog's, not the clock's.
pack "$scratch/second" || { cat "$scratch/second.log"; fail "cpack, again"; }

names="evical libevical-dev"
[ "$gui" = OFF ] || names+=" evical-gui"
[ "$python" = OFF ] || names+=" python3-evical"
for name in $names; do
  package=$(echo "$scratch/first/${name}"_*.deb)
  cmp "$package" "$scratch/second/$(basename "$package")" || fail "two runs of cpack gave different packages $name"
  dpkg-deb -x "$package" "$scratch/root"
done
# AppStream 1.0 warns correctly that there is no homepage. Newer lintian repeats its warnings, which are
# checked below.
without=() tag=appstream-metadata-validation-failed
! lintian-explain-tags "$tag" >/dev/null 2>&1 || without=(--suppress-tags "$tag")
lintian --allow-root "${without[@]}" --fail-on error,warning "$scratch"/first/*.deb || fail "lintian"

contents="bin/evical share/bash-completion/completions/evical share/man/man1/evical.1.gz share/man/man1/evical-calibrate.1.gz
  share/evical/scenarios/davis346.yaml share/evical/default.yaml include/evical/core/pipeline/session/session.h"
[ "$gui" = OFF ] || contents+=" bin/evical-gui share/man/man1/evical-gui.1.gz share/applications/evical.desktop
  share/metainfo/org.evical.evical.metainfo.xml share/mime/packages/evical.xml share/icons/hicolor/scalable/apps/evical.svg"
for file in $contents; do
  [ -s "$scratch/root/usr/$file" ] || fail "no /usr/$file in any package"
done
[ -n "$(find "$scratch/root" -name EvicalConfig.cmake)" ] || fail "libevical-dev has no EvicalConfig.cmake"
# Evical depends on Ceres or, if Ceres is static (Debian 12), on CHOLMOD, whose licence is then in the
# copyright file.
depends=$(dpkg-deb -f "$scratch"/first/evical_*.deb Depends)
if grep -q "libcholmod[0-9]" <<<"$depends"; then
  grep -q "libcholmod: .*GPL-2+" "$scratch/root/usr/share/doc/evical/copyright" || fail "copyright does not mention CHOLMOD's GPL parts"
else
  grep -q "libceres[0-9]" <<<"$depends" || fail "evical does not depend on what it links"
fi
! dpkg-deb -f "$scratch"/first/evical_*.deb Depends | grep -qi "qt\|vtk" || fail "the command line depends on Qt or VTK"

if [ "$gui" != OFF ]; then
  said=$(appstreamcli validate --no-net "$scratch/root/usr/share/metainfo/org.evical.evical.metainfo.xml") ||
    { grep -q '^W: .*url-homepage-missing' <<<"$said" &&
      [ "$(grep '^[WE]:' <<<"$said" | grep -cv url-homepage-missing)" = 0 ]; } || fail "appstreamcli: $said"
  desktop-file-validate "$scratch/root/usr/share/applications/evical.desktop" || fail "desktop-file-validate"
  version=$(dpkg-deb -f "$scratch"/first/evical_*.deb Version)
  grep -q "<release version=\"${version%-*}\"" "$scratch"/root/usr/share/metainfo/*.xml || fail "AppStream data lack version ${version%-*}"
  # Every type that the desktop entry opens is declared by us, and vice versa.
  declared=$(grep -o 'mime-type type="[^"]*' "$scratch/root/usr/share/mime/packages/evical.xml" | cut -d'"' -f2 | sort)
  opened=$(sed -n 's/^MimeType=//p' "$scratch/root/usr/share/applications/evical.desktop" | tr ';' '\n' | sed '/^$/d' | sort)
  provided=$(sed -n 's:.*<mediatype>\(.*\)</mediatype>.*:\1:p' "$scratch"/root/usr/share/metainfo/*.xml | sort)
  [ "$declared $declared" = "$opened $provided" ] || fail "types differ: declared $declared; opened $opened; provided $provided"
fi

"$scratch/root/usr/bin/evical" calibrate "$recording/session.yaml" -o "$scratch/result" --quiet >/dev/null || fail "calibrate"
[ -s "$scratch/result/result.yaml" ] || fail "no result"
if [ "$python" != OFF ]; then
  PYTHONPATH=$(dirname "$(find "$scratch/root" -path '*/evical/__init__.py' -printf '%h')") /usr/bin/python3 -c '
import sys, evical
assert evical.__file__.startswith(sys.argv[1]), evical.__file__
print(evical.Result.load(sys.argv[2]).cameras)' "$scratch/root" "$scratch/result" || fail "the Python module of the package"
fi

# If a tool is missing, the message must name the package to install. All tools except one:
mkdir "$scratch/tools"
ln -s "$(command -v cpack)" "$(command -v sh)" "$(command -v cmake)" "$(command -v file)" "$(command -v readelf)" "$(command -v gzip)" \
  "$(command -v touch)" "$scratch/tools"
! said=$(PATH="$scratch/tools" cpack --config "$build/CPackConfig.cmake" -B "$scratch/none" 2>&1) || fail "cpack continued without dpkg-dev"
[[ $said == *"dpkg-shlibdeps is missing"* && $said == *dpkg-dev* ]] || fail "dpkg-dev is not mentioned: $said"
[ -z "$(find "$scratch/none" -name '*.deb' 2>/dev/null)" ] || fail "a package was built without dpkg-dev"
! said=$(umask 077 && cpack --config "$build/CPackConfig.cmake" -B "$scratch/none" 2>&1) || fail "cpack continued with umask 077"
[[ $said == *"umask 022"* ]] || fail "the umask is not mentioned: $said"
echo "Packages: $names"
