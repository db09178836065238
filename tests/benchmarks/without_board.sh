#!/usr/bin/env bash
# The table of what is reached without a board: rooms that check an old calibration, logs of IMUs over time. Some three
# hours on one core; fails where a target is missed. BUILD is a build folder; SEEDS, 20 if not given, of each kind.
set -uo pipefail
benchmarks=${1:?the build folder}/tests/benchmarks/evical_benchmarks seeds=${2:-20}
scenarios=$(cd "$(dirname "$0")/../../config/scenarios" && pwd)
failed=0
"$benchmarks" no_board --seeds "$seeds" "$scenarios/room.yaml" || failed=1
"$benchmarks" no_board --seeds 4 --duration 30 "$scenarios/room_near.yaml" || failed=1
"$benchmarks" no_board --seeds 4 --duration 20 "$scenarios/room_vga_wide.yaml" || failed=1
"$benchmarks" maintain --seeds "$seeds" --runs 300 --hour "$scenarios/maintain" || failed=1
exit "$failed"
