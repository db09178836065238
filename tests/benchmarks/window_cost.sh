#!/usr/bin/env bash
# What a calibration costs in the window, with Detection in view at 1920x1080, beside the command line: processor time,
# peak memory, and their ratio. Wants Xvfb, a window manager and xdotool. Exit code 1 beyond 300 MB or 1.3 times.
#   window_cost.sh FOLDER_OF_PROGRAMS SESSION
set -euo pipefail
. "$(dirname "$0")/../support/xvfb.sh"
programs=$1 session=$(realpath "$2")
most_mb=300 most_ratio=1.3
scratch=$(mktemp -d)
finish() {
  kill "${program_pid:-}" 2>/dev/null || true
  stopDisplay
  rm -rf "$scratch"
}
trap finish EXIT

# Seconds of processor that a process has had, with all its threads.
cpu_s() { awk -v hz="$(getconf CLK_TCK)" '{sub(/.*\) /, ""); print ($12 + $13) / hz}' "/proc/$1/stat"; }
peak_mb() { awk '/VmHWM/ {printf "%.0f", $2 / 1024}' "/proc/$1/status"; }

# The session's own folder stays as it is, for runs are kept beside a session: its files are there by their names.
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
awk -v mb="$window_mb" -v ratio="$ratio" -v m="$most_mb" -v r="$most_ratio" 'BEGIN {exit !(mb <= m && ratio <= r)}'
