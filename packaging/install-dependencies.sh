#!/usr/bin/env bash
# Installs Debian 12 packages: packaging/install-dependencies.sh [LIST...]. Lists:
#   run         to build and run the programs (the default)
#   test        for packaging/test.sh; includes run and package
#   package     to build and check Debian packages
#   sanitizers  for packaging/sanitizers.sh and packaging/fuzz.sh
# Does nothing, and needs no root rights, if all packages are installed. With --list in front it only prints their names.
set -euo pipefail

run=(
  # build: clang needs less time than GCC
  build-essential clang cmake ninja-build ccache mold git ca-certificates
  # core
  libeigen3-dev libceres-dev libsuitesparse-dev libyaml-cpp-dev libfmt-dev libspdlog-dev
  libopencv-dev libapriltag-dev libpng-dev
  # recordings: live streams need Boost's WebSocket, ROS 1 bags are bz2 or lz4 compressed, ROS 2 bags are SQLite or MCAP,
  # AEDAT4 is lz4 or zstd; HDF5 has its own library and filters
  libboost-dev libbz2-dev liblz4-dev libzstd-dev zlib1g-dev libsqlite3-dev libhdf5-dev libblosc-dev liblzf-dev
  # command line
  libcli11-dev nlohmann-json3-dev
  # Python module
  pybind11-dev python3-dev python3-numpy
  # desktop program
  qt6-base-dev qt6-svg-dev libvtk9-dev libegl-dev libgl1-mesa-dri libglew-dev libqcustomplot-dev fonts-inter
)
package=(dpkg-dev file lintian appstream desktop-file-utils man-db)
test=(
  clang-format clang-tidy python3 xvfb xauth xdotool openbox imagemagick python3-h5py python3-rosbag slurm-wlm munge locales
  # Python module, also with AddressSanitizer, and notebooks
  libclang-rt-14-dev python3-pytest mypy python3-nbformat python3-nbconvert python3-ipykernel python3-matplotlib
  # documentation site
  mkdocs
  # other programs' loaders for the files that Evical exports, and their libraries
  python3-camera-calibration-parsers liburdfdom-tools python3-yaml libcereal-dev libgflags-dev
)
sanitizers=(libclang-rt-14-dev)

only_list=
if [ "${1:-}" = --list ]; then
  only_list=1
  shift
fi
[ "$#" -gt 0 ] || set -- run
packages=()
for list in "$@"; do
  case "$list" in
    run) packages+=("${run[@]}") ;;
    package) packages+=("${package[@]}") ;;
    test) packages+=("${run[@]}" "${package[@]}" "${test[@]}") ;;
    sanitizers) packages+=("${sanitizers[@]}") ;;
    *)
      echo "There is no list '$list'. Choose from run, test, package, sanitizers." >&2
      exit 2
      ;;
  esac
done
mapfile -t packages < <(printf '%s\n' "${packages[@]}" | awk '!seen[$0]++')

if [ -n "$only_list" ]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
if [ "${#missing[@]}" -eq 0 ]; then
  echo "All packages are installed."
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing: ${missing[*]}. Install them as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null

# The Slurm test starts its own daemons: those of the packages must not run, now or at boot.
if [[ " ${missing[*]} " == *" slurm-wlm "* ]] && command -v systemctl >/dev/null; then
  for service in slurmctld slurmd munge; do
    "${as_root[@]}" systemctl disable --now "$service" >/dev/null 2>&1 || "${as_root[@]}" systemctl disable "$service" >/dev/null 2>&1 || true
  done
fi
