#!/usr/bin/env bash
# Prints every figure of docs/accuracy.md: packaging/benchmarks.sh [GROUP...]. Without groups all run, for more than a night.
#   accuracy       all scenarios of config/scenarios, seeds, circle centres, start times
#   laboratories   random rigs, boards, lenses, light and motions, and single faults in them: an hour
#   boards         boards of squares before event cameras: eight hours
#   lenses         frame cameras and intrinsics; also real recordings, if EVICAL_DATA is set
#   checks         single deviations from the session, several recordings of a rig, an old result against a new recording
#   without-board  rooms, and logs of IMUs over time: three hours
#   speed          the costs of the hot paths, of the desktop program and of reading files
# Fails if a wrong result is called ok, if the ratio of errors to sigmas over twenty seeds is outside 0.7 to 1.4, or if a
# benchmark misses its targets.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 2

groups=(accuracy laboratories boards lenses checks without-board speed)
[ "$#" -gt 0 ] || set -- "${groups[@]}"
for group in "$@"; do
  if [[ " ${groups[*]} " != *" $group "* ]]; then
    echo "There is no group '$group'. Choose from: ${groups[*]}" >&2
    exit 2
  fi
done

packaging/install-dependencies.sh test
cmake --fresh --preset release -DEVICAL_TESTS=ON
cmake --build --preset release --target evical evical-gui evical_benchmarks || exit 1
scenarios=config/scenarios
failed=0

run() {
  build/release/tests/benchmarks/evical_benchmarks "$@" && return
  failed=1
  echo "FAILED: evical_benchmarks $*"
}

# All scenarios except those without a board, those for intrinsics, and those for many seeds.
rigs=("$scenarios"/{stereo,stereo_two_imus,three_cameras,disjoint_views}.yaml)
single=()
for file in "$scenarios"/*.yaml; do
  case "$(basename "$file" .yaml)" in
    intrinsics_* | symmetric_board | blinking | wide_frame | room* | *_10s | stereo* | three_cameras | disjoint_views) ;;
    *) single+=("$file") ;;
  esac
done

run_accuracy() {
  run accuracy --verdicts "${single[@]}"
  run accuracy --verdicts --quantities "${rigs[@]}"
  for file in "$scenarios"/*_10s.yaml; do run accuracy --verdicts --seeds 20 "$file"; done
  # Circle centres along the motion, in ordinary and in small motions.
  run centre_errors --speeds --agreement --duration 10 \
    "$scenarios"/{small_motion,davis346,slow,bare_7x3_fast,noisy,board_9x4,realistic}.yaml
  run board_starts --duration 20 "${single[@]}"
}

run_laboratories() {
  run laboratories --family all --seeds 40 --agreement --faults 8
}

run_boards() {
  run boards --seeds 20 --part imu --part lens --part hybrid --part time
  run boards --seeds 5 --part families
}

run_lenses() {
  run frame_cameras
  run intrinsics "$scenarios"/intrinsics_*.yaml
  run intrinsics --seeds 10 --duration 15 "$scenarios/intrinsics_davis346.yaml"
  run intrinsics --seeds 20 "$scenarios/wide_frame.yaml"
  run unknown_intrinsics --seeds 6 --duration 10 "$scenarios/intrinsics_davis346.yaml"
}

run_checks() {
  run stress "$scenarios/davis346_10s.yaml"
  run stress --perfect --seeds 5 "$scenarios/davis346_10s.yaml"
  run stress --perfect --seeds 5 --duration 30 "$scenarios/davis346_10s.yaml"
  # Five recordings of each of three boards, alone and together: half an hour.
  run protocol --folder "$(mktemp -d)/recording" config/protocol
  run check "$scenarios/davis346.yaml"
}

run_without-board() {
  tests/benchmarks/without_board.sh build/release || failed=1
}

run_speed() {
  run speed "$scenarios/davis346.yaml"
  run costs "$scenarios"/{bare_7x3_fast,stereo_two_imus}.yaml --durations 20
  run costs "$scenarios/davis346.yaml" --durations 10 30 60 120
  run speed --duration 3 "$scenarios/hd.yaml"

  # A run in the desktop program compared with one on the command line.
  local window
  window=$(mktemp -d)
  printf 'base: %s/config/scenarios/davis346.yaml\n' "$PWD" > "$window/scenario.yaml"
  build/release/evical simulate "$window/scenario.yaml" -o "$window/recording" --quiet
  tests/benchmarks/window_cost.sh build/release "$window/recording/session.yaml" || failed=1
  rm -rf "$window"

  # Decoding speed per format; fails if a packed format is below 20 million events/s.
  run formats "$scenarios/davis346.yaml"
}

for group in "$@"; do "run_$group"; done
exit "$failed"
