#!/usr/bin/env bash
# Installs what building and testing Evical needs, from Debian 12's own packages. Does nothing, and asks for no rights,
# when all of it is there. With --list it only prints the names; --fuzz in front adds what packaging/fuzz.sh needs.
set -euo pipefail

packages=(
  # build
  build-essential cmake ninja-build ccache git ca-certificates
  # core
  libeigen3-dev libceres-dev libsuitesparse-dev libyaml-cpp-dev libfmt-dev libspdlog-dev
  libopencv-dev libapriltag-dev libpng-dev
  # recordings: ROS 1 bags are bz2 or lz4 compressed, ROS 2 bags are SQLite or MCAP, AEDAT4 is lz4 or zstd; HDF5 has its
  # own library and filters
  libbz2-dev liblz4-dev libzstd-dev zlib1g-dev libsqlite3-dev libhdf5-dev libblosc-dev liblzf-dev
  # command line
  libcli11-dev nlohmann-json3-dev
  # Python module, its tests and its notebooks
  pybind11-dev python3-dev python3-numpy python3-pytest mypy python3-nbformat python3-nbconvert python3-ipykernel python3-matplotlib
  # desktop program
  qt6-base-dev qt6-svg-dev libvtk9-dev libegl-dev libgl1-mesa-dri libglew-dev libqcustomplot-dev fonts-inter
  # tests
  clang-format clang-tidy python3 xvfb xauth xdotool openbox imagemagick python3-h5py python3-rosbag slurm-wlm munge
  # documentation site
  mkdocs
  # packages, and what looks at them
  dpkg-dev file lintian appstream desktop-file-utils man-db
  # other programs' loaders of what Evical exports, and libraries that they read with
  python3-camera-calibration-parsers liburdfdom-tools python3-yaml libcereal-dev libgflags-dev
)

if [ "${1:-}" = "--fuzz" ]; then
  packages+=(clang libclang-rt-14-dev)
  shift
fi

if [ "${1:-}" = "--list" ]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
if [ "${#missing[@]}" -eq 0 ]; then
  echo "All packages are there."
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
