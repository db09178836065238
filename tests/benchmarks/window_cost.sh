#!/usr/bin/env bash
# Cost of a calibration in the window, with Detection in view at 1920x1080, compared with the command line:
# processor time, peak memory, and their ratio. Needs Xvfb, a window manager and xdotool. Exit code 1 beyond
# 300 MB or 1.3 times.
# window_cost.sh FOLDER_OF_PROGRAMS SESSION
set -euo pipefail
. "$(dirname "$0")/../support/xvfb.sh"
programs=$1 session=$(realpath "$2")
max_mb=300 max_ratio=1.3
scratch=$(mktemp -d)
finish() {
  kill "${program_pid:-}" 2>/dev/null || true
  stopDisplay
  rm -rf "$scratch"
}
trap finish EXIT

# Processor time of a process with all its threads, in seconds.
cpu_s() { awk -v hz="$(getconf CLK_TCK)" '{sub(/.*\) /, ""); print ($12 + $13) / hz}' "/proc/$1/stat"; }
peak_mb() { awk '/VmHWM/ {printf "%.0f", $2 / 1024}' "/proc/$1/status"; }

# Links to the session's files in a copy of its folder: runs are saved next to a session, and the original
# must not change.
ln -s "$(dirname "$session")"/* "$scratch"
rm -rf "$scratch"/*.runs "$scratch/$(basename "$session")"
cp "$session" "$scratch/session.yaml"

TIMEFORMAT='%U %S'
line_s=$({ time "$programs/evical" calibrate "$scratch/session.yaml" -o "$scratch/line" --quiet >/dev/null 2>&1; } 2>&1 | awk '{printf "%.2f", $1 + $2}')
line_mb=$(awk '/^memory_peak_mb:/ {print $2}' "$scratch/line/result.yaml")

startDisplay 1920x1080
startWindowManager
${PROFILE:-} "$programs/evical-gui" "$scratch/session.yaml" 2>"$scratch/errors" &
program_pid=$!
window=$(timeout 60 xdotool search --sync --onlyvisible --name Evical | head -1)
xdotool windowmove "$window" 0 0 windowsize "$window" 1920 1080
xdotool windowactivate --sync "$window" key ctrl+3
sleep 1
before_s=$(cpu_s "$program_pid") before_mb=$(peak_mb "$program_pid")
xdotool key F5
for _ in $(seq 1200); do
  sleep 0.25
  compgen -G "$scratch/session.runs/*/result.yaml" >/dev/null && break
done
sleep 1
window_s=$(cpu_s "$program_pid") window_mb=$(peak_mb "$program_pid") # from its start
compgen -G "$scratch/session.runs/*/result.yaml" >/dev/null || { echo "No run was kept" >&2; cat "$scratch/errors" >&2; exit 1; }

ratio=$(awk -v a="$window_s" -v before="$before_s" -v b="$line_s" 'BEGIN {printf "%.2f", (a - before) / b}')
echo "| | processor, s | peak, MB |"
echo "|---|---|---|"
echo "| evical calibrate | $line_s | $line_mb |"
echo "| evical-gui, started and opened | $before_s | $before_mb |"
echo "| evical-gui, with the run, Detection in view | $window_s (the run $ratio times) | $window_mb |"
awk -v mb="$window_mb" -v ratio="$ratio" -v m="$max_mb" -v r="$max_ratio" 'BEGIN {exit !(mb <= m && ratio <= r)}'
