#!/usr/bin/env bash
# Prints the accuracy table of the README: every scenario that a calibration must master, then the seeds, then the costs of
# the hot paths and of reading files. Takes half an hour on two cores.
set -uo pipefail
cd "$(dirname "$0")/.."

packaging/install-dependencies.sh
cmake --preset release -DEVICAL_TESTS=ON
cmake --build --preset release --target evical_accuracy evical_intrinsics_accuracy evical_unknown_intrinsics evical_formats evical_speed \
                                       evical_stress evical_centre_errors
accuracy=build/release/tests/benchmarks/evical_accuracy
scenarios=config/scenarios

"$accuracy" "$scenarios"/{davis346,board_9x4,board_7x3,bare_7x3_fast,vga,hd,fisheye,noisy,fast,slow,shaky,large_offset}.yaml \
            "$scenarios"/{imu_200hz,badly_scaled_imu,partial_views,near,far,bright_circles,low_contrast}.yaml \
            "$scenarios"/{blur_0.4px,blur_1px,threshold_0.15,threshold_0.5}.yaml \
            "$scenarios"/{planar_motion,one_axis_rotation,hardly_moving}.yaml
"$accuracy" --quantities "$scenarios"/{stereo,stereo_two_imus,three_cameras,disjoint_views}.yaml
"$accuracy" --seeds 20 "$scenarios/davis346_10s.yaml"

# Circle centres along the motion, in ordinary and in small motions.
build/release/tests/benchmarks/evical_centre_errors --speeds --duration 10 "$scenarios"/{small_motion,davis346,slow,bare_7x3_fast,noisy,board_9x4}.yaml

intrinsics=build/release/tests/benchmarks/evical_intrinsics_accuracy
"$intrinsics" "$scenarios"/intrinsics_{davis346,fisheye,symmetric}.yaml
"$intrinsics" --seeds 10 --duration 15 "$scenarios/intrinsics_davis346.yaml"
build/release/tests/benchmarks/evical_unknown_intrinsics --seeds 6 --duration 10 "$scenarios/intrinsics_davis346.yaml"

# One thing at a time that is not as the session says; fails where a wrong result is called ok.
build/release/tests/benchmarks/evical_stress "$scenarios/davis346_10s.yaml"

speed=build/release/tests/benchmarks/evical_speed
"$speed" "$scenarios/davis346.yaml"
"$speed" --duration 3 "$scenarios/hd.yaml"

# How fast files are decoded, per format; fails where a packed one is below 20 million events/s.
build/release/tests/benchmarks/evical_formats "$scenarios/davis346.yaml"
