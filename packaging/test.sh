#!/usr/bin/env bash
# Installs missing packages, checks the format, the texts and the size of each folder, builds with warnings as errors, runs
# clang-tidy on the sources that differ from the upstream branch, and the tests. With --all, like CI: clang-tidy on recently
# changed sources, and also the tests of tests/slow_tests.txt; those labelled nightly are left to packaging/nightly.sh.
# At the end it prints wall time and processor time of each step. Fails if a build without hits in ccache needed much more
# processor time than its budget.
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in
  '' | --all) ;;
  *) echo "There is no '$1'. Usage: packaging/test.sh [--all]" >&2; exit 2 ;;
esac
all=${1:-}

# Processor time of a build without hits in ccache, divided by that of compiling packaging/build_reference.cpp on the same machine.
build_budget=125
build_may_exceed_percent=15

times=() failed=()
scratch=$(mktemp -d)
# Sets processor_cs: processor time of all ended children, in hundredths of a second. Not in a subshell, which has no children.
count_processor() {
  times >"$scratch/times"
  processor_cs=$(awk 'NR == 2 { split($1, u, /[ms]/); split($2, s, /[ms]/); printf "%d", 100 * (60 * (u[1] + s[1]) + u[2] + s[2]) }' "$scratch/times")
}
step() { # NAME COMMAND...
  local name=$1 begin=$SECONDS code=0 before
  count_processor
  before=$processor_cs
  shift
  "$@" || code=$?
  count_processor
  last_processor_cs=$((processor_cs - before))
  times+=("$(printf '%-20s %6d s %6d s' "$name" $((SECONDS - begin)) $((last_processor_cs / 100)))")
  [ "$code" -eq 0 ] || failed+=("$name")
  return "$code"
}
summary() {
  printf '\n%-20s %8s %8s\n' step wall CPU
  [ "${#times[@]}" -eq 0 ] || printf '%s\n' "${times[@]}"
  count_processor
  printf '%-20s %6d s %6d s\n' "total" "$SECONDS" $((processor_cs / 100))
  [ "${#failed[@]}" -eq 0 ] || printf 'Failed: %s\n' "${failed[*]}"
}
trap 'summary; rm -rf "$scratch"' EXIT

# Compiles the reference twice at a time, like the build: its processor time depends on what the machine's other core does.
reference_cs=0 references=0
compile_reference() {
  local before
  count_processor
  before=$processor_cs
  for k in 1 2; do
    CCACHE_DISABLE=1 clang++ -std=c++20 -O3 -isystem /usr/include/eigen3 -c packaging/build_reference.cpp -o "$scratch/reference$k.o" &
  done
  wait -n && wait -n || return 1
  count_processor
  reference_cs=$((reference_cs + processor_cs - before)) references=$((references + 2))
}
# Compares the processor time of the build with its budget. Builds with hits in ccache are not comparable.
check_build_budget() {
  local hits misses ratio
  hits=$(grep -c '_cache_hit$' build/ccache.log || true)
  misses=$(grep -c '^cache_miss$' build/ccache.log || true)
  if [ "$misses" -lt 150 ] || [ "$hits" -gt $((misses / 50)) ]; then
    echo "Build budget: not checked, since $hits of $((hits + misses)) objects came from ccache."
    return
  fi
  compile_reference || return 1
  ratio=$((build_cs * references / reference_cs))
  echo "Build budget: the build took $ratio times the reference's $((reference_cs / references / 100)) s of processor time; the budget is $build_budget."
  if [ $((100 * ratio)) -gt $((build_budget * (100 + build_may_exceed_percent))) ]; then
    echo "The build has become slower. 'ninja -C build/ci -d stats' and build/ci/.ninja_log show where. If it is worth it, raise build_budget in packaging/test.sh." >&2
    return 1
  fi
}

run_tests() {
  local slow known
  slow=$(paste -sd '|' tests/slow_tests.txt)
  known=$(ctest --preset ci -N -FA . -R "^($slow)$" | grep -c 'Test *#' || true)
  if [ "$known" -ne "$(wc -l <tests/slow_tests.txt)" ]; then
    echo "tests/slow_tests.txt: $known of its $(wc -l <tests/slow_tests.txt) lines are names of tests. Remove the others." >&2
    return 1
  fi
  if [ "$all" = --all ]; then
    ctest --preset ci -LE 'realtime|nightly'
  else
    echo "Without the $known tests of tests/slow_tests.txt: packaging/test.sh --all runs them, too."
    ctest --preset ci -LE 'realtime|nightly' -E "^($slow)$"
  fi
}

step install packaging/install-dependencies.sh test
step format packaging/check-format.sh
step texts packaging/check_texts.py
step weight packaging/weight.sh --check
step configure cmake --fresh --preset ci
# Before and after a build from the start, since a machine's speed varies.
[ -e build/ci/.ninja_log ] || step reference compile_reference
rm -f build/ccache.log
CCACHE_STATSLOG=$PWD/build/ccache.log step build cmake --build --preset ci
build_cs=$last_processor_cs
step "build budget" check_build_budget
step clang-tidy packaging/check-tidy.sh "$([ "$all" = --all ] && echo --recent || echo --changed)"
step tests run_tests
step "real-time tests" packaging/realtime-tests.sh
# Processor time of a calibration's stages.
cat build/ci/speed_guard.txt 2>/dev/null || true
