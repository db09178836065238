#!/usr/bin/env bash
# Checks that are too slow for each commit: packaging/nightly.sh [STEP...]. Without steps all run, which takes a night or longer.
#   gcc         build with GCC, each source alone (without unity), warnings as errors; run all tests except the real-time ones
#   debug       build the preset debug (-O0, -O1 for code that processes recordings, assertions), and run the same tests
#   sanitizers  packaging/sanitizers.sh
#   fuzz        packaging/fuzz.sh, one hour over all targets
#   tidy        clang-tidy on all sources
#   accuracy laboratories boards lenses checks without-board speed    packaging/benchmarks.sh, with their targets
# A failed step does not stop the others. Output is in build/nightly/STEP.log; the exit code is 1 if a step has failed.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 2

steps=(gcc debug sanitizers fuzz tidy accuracy laboratories boards lenses checks without-board speed)
[ "$#" -gt 0 ] || set -- "${steps[@]}"
for step in "$@"; do
  if [[ " ${steps[*]} " != *" $step "* ]]; then
    echo "There is no step '$step'. Choose from: ${steps[*]}" >&2
    exit 2
  fi
done

# With all errors of the build in the log. Real-time limits apply to release builds only: packaging/realtime-tests.sh.
build_and_test() { # FOLDER TIMEOUT_s CMAKE_ARGUMENT...
  local folder=$1 timeout_s=$2
  shift 2
  cmake --fresh -B "$folder" "$@" && cmake --build "$folder" -j2 -- -k 0 &&
    ctest --test-dir "$folder" -LE realtime --output-on-failure -j2 --timeout "$timeout_s"
}
run_step() {
  case "$1" in
    gcc) build_and_test build/gcc 1500 --preset gcc -DEVICAL_UNITY=OFF ;;
    debug) build_and_test build/debug 7200 --preset debug ;;
    sanitizers) packaging/sanitizers.sh ;;
    fuzz) packaging/fuzz.sh 190 ;; # seconds for each of 19 targets
    tidy) packaging/check-tidy.sh ;;
    *) packaging/benchmarks.sh "$1" ;;
  esac
}

mkdir -p build/nightly
packaging/install-dependencies.sh test sanitizers || exit 1
table=() failed=0
for step in "$@"; do
  begin=$SECONDS outcome=passed
  echo "$step: output in build/nightly/$step.log"
  run_step "$step" >"build/nightly/$step.log" 2>&1 || { outcome=FAILED; failed=1; tail -n 40 "build/nightly/$step.log"; }
  table+=("$(printf '%-13s %7d s  %s' "$step" $((SECONDS - begin)) "$outcome")")
done
printf '\n'
printf '%s\n' "${table[@]}"
exit "$failed"
