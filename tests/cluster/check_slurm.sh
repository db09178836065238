#!/usr/bin/env bash
# A batch on a cluster: Slurm with two nodes on this machine, 20 short recordings, of which one is too short
# and one is truncated. A node fails during its work. Nothing may be lost, no finished job may run again, and
# the table must equal that of a single machine.
# check_slurm.sh EVICAL SIMULATED SCRATCH
# Exit code 77: Slurm is missing, cannot be started by this user, or does not start on this machine.
set -euo pipefail
evical=$1 simulated=$2 scratch=$3
export LC_ALL=C.UTF-8

fail() {
  echo "check_slurm: $*" >&2
  for log in "$scratch"/log/*; do
    echo "--- $log" >&2
    tail -15 "$log" >&2
  done
  exit 1
}
skip() {
  echo "check_slurm: skipped: $*"
  exit 77
}

PATH=$PATH:/usr/sbin:/sbin
for tool in munged slurmctld slurmd sbatch squeue sinfo scontrol; do
  command -v "$tool" >/dev/null || skip "$tool is not there (Debian's packages slurm-wlm and munge)"
done
[ "$(id -u)" = 0 ] || skip "only root may start slurmd"

rm -rf "$scratch"
mkdir -p "$scratch"/{log,state,spool,data}
export SLURM_CONF=$scratch/slurm.conf

# Three free ports.
read -r control_port first_port second_port < <(python3 -c '
import socket
sockets = [socket.socket() for _ in range(3)]
for each in sockets: each.bind(("127.0.0.1", 0))
print(*(each.getsockname()[1] for each in sockets))')

cat >"$SLURM_CONF" <<CONF
ClusterName=evical
SlurmctldHost=localhost
SlurmctldPort=$control_port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$scratch/munge.socket,cred_expire=6
CredType=cred/munge
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool/%n
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.%n.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=6
KillWait=1
MessageTimeout=10
SchedulerParameters=sched_interval=2,sched_min_interval=100000
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$first_port CPUs=1
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$second_port CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES State=UP MaxTime=INFINITE
CONF

# Processes of a node: its slurmd, the keepers of its job steps, then the jobs themselves. All must stop
# within milliseconds, since a job takes only a second and must not end meanwhile.
kill_node() { # NAME
  local name=$1 process jobs=() keepers=()
  mapfile -t jobs < <({ grep -lzxF "SLURMD_NODENAME=$name" /proc/[0-9]*/environ |
    xargs -r grep -lzxF "SLURM_CONF=$SLURM_CONF" | cut -d/ -f3; } 2>/dev/null)
  [ "${#jobs[@]}" = 0 ] || mapfile -t keepers < <(ps -o ppid= -p "${jobs[*]}" | tr -d ' ')
  kill -KILL "$(cat "$scratch/slurmd.$name.pid")" 2>/dev/null || true
  for process in "${keepers[@]}"; do
    grep -q slurmstepd "/proc/$process/comm" 2>/dev/null && kill -KILL "$process"
  done
  for process in "${jobs[@]}"; do kill -KILL "$process" 2>/dev/null || true; done
}

stop_all() {
  kill_node n1 || true
  kill_node n2 || true
  for pid in "$scratch"/slurmctld.pid "$scratch"/munged.pid; do
    [ ! -s "$pid" ] || kill -KILL "$(cat "$pid")" 2>/dev/null || true
  done
}
trap stop_all EXIT

dd if=/dev/urandom of="$scratch/munge.key" bs=1024 count=1 status=none
chmod 400 "$scratch/munge.key"
munged --force --key-file="$scratch/munge.key" --socket="$scratch/munge.socket" --pid-file="$scratch/munged.pid" \
  --seed-file="$scratch/munge.seed" --log-file="$scratch/log/munged" || skip "munged does not start"
slurmctld -L "$scratch/log/slurmctld" || skip "slurmctld does not start"
for node in n1 n2; do
  mkdir -p "$scratch/spool/$node"
  slurmd -N "$node" -L "$scratch/log/$node" || skip "slurmd of $node does not start"
done

within() { # SECONDS COMMAND...: waits until it succeeds
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.5
  done
}
both_idle() { [ "$(sinfo --noheader --Node --format=%T | grep -c '^idle$')" = 2 ]; }
within 30 both_idle || skip "the nodes do not start: $(sinfo 2>&1)"

# 20 jobs: 18 of a complete recording, one that is too short, one that was truncated.
recording=$simulated/short_bag/recording.bag
head -c $(($(stat -c %s "$recording") * 7 / 10)) "$recording" >"$scratch/data/cut.bag"
{
  echo "evical_batch: 1"
  echo "session: $simulated/short_bag/session.yaml"
  echo "set: {time_range_s: '[0, 5]'}"
  echo "jobs:"
  for k in $(seq -w 18); do
    ln -s "$recording" "$scratch/data/$k.bag"
    echo "  - {name: r$k, recording: data/$k.bag}"
  done
  echo "  - {name: too_short, session: $simulated/still/session.yaml, set: {time_range_s: '[0, 2]'}}"
  echo "  - {name: cut, recording: data/cut.bag}"
} >"$scratch/jobs.yaml"

cluster="$scratch/my cluster, 50 %a" machine=$scratch/machine
"$evical" batch "$scratch/jobs.yaml" -o "$cluster" --slurm | tee "$scratch/log/submitted" || fail "it was not submitted"
grep -q "Submitted 20 jobs" "$scratch/log/submitted" || fail "not all were submitted"

# The second node goes down during its work, after it has finished a job.
some_done() { [ "$(find "$cluster/jobs" -name 'r*.yaml' ! -name '*.session.yaml' | wc -l)" -ge 3 ]; }
# Waits for a job that is running there.
busy_on() {
  local task
  task=$(squeue --noheader --states=R --format='%N %K' | sed -n "s/^$1 //p")
  [ -n "$task" ] && tail -n 1 "$cluster/jobs/slurm-$task.txt" | grep -q ': started$'
}
within 240 some_done || fail "no job has ended: $(squeue 2>&1)"
"$evical" batch "$scratch/jobs.yaml" -o "$cluster" --collect --quiet >"$scratch/log/early" && fail "a partial collection was not reported"
grep -q "is in Slurm's queue: " "$scratch/log/early" || fail "waiting jobs are not reported: $(cat "$scratch/log/early")"
within 60 busy_on n2 || fail "the second node has no job: $(squeue 2>&1)"
kill_node n2

queue_empty() { [ -z "$(squeue --noheader)" ]; }
within 600 queue_empty || fail "the queue does not become empty: $(squeue 2>&1; sinfo 2>&1)"
sinfo --noheader --Node --format='%N %T' | grep -q '^n2 down' || fail "n2 was not lost: $(sinfo --Node 2>&1)"

"$evical" batch "$scratch/jobs.yaml" -o "$cluster" --collect >"$scratch/log/collected" || true
"$evical" batch "$scratch/jobs.yaml" -o "$machine" >"$scratch/log/machine" || true

# Everything except time and memory.
table() { python3 -c '
import csv, sys
for row in csv.reader(open(sys.argv[1])): print(row[:-2])' "$1/batch.csv"; }
diff <(table "$cluster") <(table "$machine") || fail "the cluster's table differs from the machine's"
[ "$(table "$cluster" | grep -cE "'(ok|doubtful)'")" -ge 18 ] || fail "results are missing: $(cat "$scratch/log/collected")"
grep -q "too_short: .*too short" "$scratch/log/collected" || fail "the failure is not reported"

# Each was started once, except those that the node lost.
begun=$(cat "$cluster"/jobs/slurm-*.txt | grep -c ': started$')
twice=$(cat "$cluster"/jobs/slurm-*.txt | grep ': started$' | sort | uniq -d | wc -l)
[ "$begun" = 21 ] && [ "$twice" = 1 ] || fail "$begun starts, $twice jobs started twice"
"$evical" batch "$scratch/jobs.yaml" -o "$cluster" --slurm | grep -q "nothing was submitted" || fail "finished jobs were submitted again"
echo "check_slurm: 20 jobs over two nodes, one lost: the same table as on one machine"
