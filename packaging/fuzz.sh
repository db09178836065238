#!/usr/bin/env bash
# Fuzzes every parser for SECONDS each (60 by default), with AddressSanitizer and UndefinedBehaviorSanitizer:
# packaging/fuzz.sh [SECONDS [TARGET...]]. Seeds are small generated files and those of tests/data; the corpus is kept in
# build/fuzz/corpus. Findings are kept in build/fuzz/findings and fail the script;
# build/fuzz/tests/fuzz/evical_fuzz_TARGET FILE reproduces one.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
targets=("${@:2}")
[ "${#targets[@]}" -gt 0 ] || targets=(bag mcap db3 packed aedat2 aedat3 aedat4 hdf5 npy npz raw es text tables pictures dv foxglove payload detections run_data yaml calibrate)

packaging/install-dependencies.sh test sanitizers
build=build/fuzz
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
      -DEVICAL_FUZZ=ON -DEVICAL_GUI=OFF >/dev/null
nice -n 10 ninja -C "$build" -j2 evical_fuzz

seeds=$build/seeds
rm -rf "$seeds"
ASAN_OPTIONS=detect_leaks=0 "$build/tests/fuzz/evical_fuzz_seeds" "$seeds"
/usr/bin/python3 tests/fuzz/hdf5_seeds.py "$seeds/hdf5"
cp tests/fuzz/seeds/hdf5/*.h5 "$seeds/hdf5"
mkdir -p "$seeds/dv"
for file in "$seeds"/aedat4/*; do tail -c +15 "$file" >"$seeds/dv/$(basename "$file")"; done  # without the first line
mkdir -p "$seeds/tables" "$seeds/yaml" "$seeds/calibrate" "$seeds/run_data"
for kind in $(seq 0 11); do  # a disturbance of each kind, about a second long, in the middle
  printf "\\x$(printf %02x "$kind")\\x60\\xa0\\x06\\x01\\x02" >"$seeds/calibrate/$kind"
done
cp -r tests/fuzz/seeds/detections "$seeds"
cp tests/fuzz/seeds/yaml/*.yaml config/*.yaml config/scenarios/*.yaml "$seeds/yaml"
while IFS= read -r -d '' file; do
  case "$(head -c 8 "$file" | tr -d '\0')" in
    '#ROSBAG'*) target=bag ;;
    'SQLite'*) target=db3 ;;
    *MCAP*) target=mcap ;;
    *HDF*) target=hdf5 ;;
    *NUMPY*) target=npy ;;
    PK*) target=npz ;;
    [0-9]*) target=text ;;
    *) continue ;;
  esac
  cp "$file" "$seeds/$target/$(basename "$file")"
done < <(find tests/data -type f -size -64k -print0)

mkdir -p "$build/findings"
failed=0
for target in "${targets[@]}"; do
  corpus=$build/corpus/$target
  mkdir -p "$corpus"
  # libhdf5 leaks memory on damaged files, which we cannot free. It also allocates the sizes that they claim: the system
  # refuses these, and libhdf5 reports an error.
  leaks=1 allocations= patience=20
  [ "$target" != hdf5 ] || { leaks=0 allocations=allocator_may_return_null=1; }
  # Libraries that are not built with the sanitizers share containers with code that is, and have separate memory pools.
  case "$target" in calibrate | yaml) leaks=0 allocations=detect_container_overflow=0 ;; esac
  [ "$target" != calibrate ] || patience=300
  if ASAN_OPTIONS=$allocations LSAN_OPTIONS=suppressions=tests/fuzz/leaks.supp:print_suppressions=0 \
     UBSAN_OPTIONS=print_stacktrace=1 nice -n 10 "$build/tests/fuzz/evical_fuzz_$target" "$corpus" "$seeds/$target" \
       -max_total_time="$seconds" -max_len=65536 -timeout="$patience" -rss_limit_mb=2048 -malloc_limit_mb=1024 \
       -detect_leaks="$leaks" -print_final_stats=1 -artifact_prefix="$build/findings/$target-" \
       >"$build/$target.log" 2>&1; then
    echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$target.log") inputs, nothing found"
  else
    failed=1
    echo "$target: failed, see $build/$target.log"
  fi
done
exit "$failed"
