#!/bin/sh
# Run by packaging/test-packages.sh inside a bare Debian 12: installs each package, uses it as an ordinary user, removes and purges
# it, and checks that no files are left.
set -eu
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
cd /srv/in

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
as_user() { # COMMAND: in the user's folder
  setpriv --reuid=1000 --regid=1000 --clear-groups env -i HOME=/srv/user PATH=/usr/bin:/bin LC_ALL=C.UTF-8 sh -euc "cd /srv/user; $1"
}
everything() { # all files except those of the package managers
  find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /srv -o -path /tmp -o -path /run -o -path /var/cache -o -path /var/log \
    -o -path /var/lib/apt -o -path /var/lib/dpkg \) -prune -o -print | sort
}
deb() { # NAME: its file
  ls packages/"$1"_*.deb
}
# Dependencies are installed first, so that the package's own files can be identified.
install_package() {
  file=$PWD/$(deb "$1")
  apt-get satisfy -y -qq --no-install-recommends "$(dpkg-deb -f "$file" Depends)" >/dev/null
  everything >before.txt
  apt-get install -y -qq --no-install-recommends "$file" >/dev/null
  dpkg -s "$1" | grep -q '^Status: install ok installed' || fail "$1 is not installed"
  [ -s "/usr/share/doc/$1/copyright" ] || fail "$1 has no copyright"
}
purge_package() {
  apt-get remove -y -qq "$1" >/dev/null
  dpkg --purge "$1" 2>/dev/null # apt cannot purge a removed package without configuration files
  everything >after.txt
  cmp -s before.txt after.txt || { diff before.txt after.txt; fail "$1 leaves files behind, or takes others' away"; }
  echo "$1: installed, used, removed, purged, nothing left."
}

mkdir -p /srv/user
chown 1000:1000 /srv/user
apt-get update -qq

install_package evical
[ -s /usr/share/bash-completion/completions/evical ] || fail "no completion"
[ -s /usr/share/man/man1/evical-calibrate.1.gz ] || fail "no manual page"
as_user 'evical simulate /usr/share/evical/scenarios/davis346.yaml -o demo --quiet'
as_user 'evical init demo/recording.bag -o guessed.yaml --quiet'
as_user 'evical calibrate demo/session.yaml -o demo/result'
as_user 'evical compare demo/result/result.yaml demo/truth.yaml'
grep -q '^status: ok' /srv/user/demo/result/result.yaml || fail "the demo's result is not ok"
purge_package evical

install_package evical-gui
as_user 'QT_QPA_PLATFORM=offscreen evical-gui --screenshot result -o result.png demo/result'
[ -s /srv/user/result.png ] || fail "evical-gui wrote no picture"
purge_package evical-gui

apt-get install -y -qq --no-install-recommends cmake g++ make >/dev/null
install_package libevical-dev
cp -r examples /srv/user/examples
chown -R 1000:1000 /srv/user/examples
as_user 'cmake -S examples -B build >/dev/null && cmake --build build >/dev/null && build/read_events demo/recording.bag'
purge_package libevical-dev

if [ -n "$(find packages -name 'python3-evical_*')" ]; then
  install_package python3-evical
  as_user 'python3 -c "import evical; print(evical.Result.load(\"demo/result\").cameras)"'
  purge_package python3-evical
fi
