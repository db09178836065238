#!/usr/bin/env bash
# Table of the accuracy without a board: checks of an old calibration in rooms, logs of IMUs over time. Takes
# three hours on one core; fails if a target is missed. BUILD is a build folder; SEEDS is the number of seeds
# of each kind, 20 by default.
set -uo pipefail
benchmarks=${1:?the build folder}/tests/benchmarks/evical_benchmarks seeds=${2:-20}
scenarios=$(cd "$(dirname "$0")/../../config/scenarios" && pwd)
failed=0
"$benchmarks" no_board --seeds "$seeds" "$scenarios/room.yaml" || failed=1
"$benchmarks" no_board --seeds 4 --duration 30 "$scenarios/room_near.yaml" || failed=1
"$benchmarks" no_board --seeds 4 --duration 20 "$scenarios/room_vga_wide.yaml" || failed=1
"$benchmarks" maintain --seeds "$seeds" --runs 300 --hour "$scenarios/maintain" || failed=1
exit "$failed"
