#!/usr/bin/env bash
# A run on a Slurm cluster, in one of two shapes:
#   launch-slurm.sh array N [SBATCH-OPTIONS...] -- STAGE RUN-OPTIONS...
#       Ventilator and sink here (on a login node, or inside a job of your own), and a job array of N
#       workers: an element that loses its node is queued again by itself, the others go on. The
#       array is cancelled when the run ends. For long runs.
#   launch-slurm.sh allocation N [SBATCH-OPTIONS...] -- STAGE RUN-OPTIONS...
#       All of it in one job of N nodes, a worker on each. A node that fails takes its worker with it
#       and the run goes on with the others; if it is the first, Slurm starts the job again, and
#       the run goes on from the stage.
#   launch-slurm.sh array 16 --partition=short --cpus-per-task=4 -- /nfs/stage/lucy --ratio 0.01
# Each worker simplifies as many parts at once as it has CPUs (SLURM_CPUS_PER_TASK). What workers and
# the job say goes to STAGE.slurm-JOB.log. Slurm's own exit codes say nothing about the run: what
# counts, here too, is the word of the ventilator: 0 done, 1 failed, 2 wrong usage, 3 incomplete but
# resumable by the same command.
#   MESHFARM  the program, at the same path on all nodes (default: the one built beside this script)
set -euo pipefail

# A worker of the array: run_element PROGRAM STAGE WORDS... All it needs is passed as arguments, as
# a site may not pass on the environment (--export=NONE). A worker that left before the run was over
# (3: one of its jobs hung, or its ventilator did not answer) is started again, unless it was asked
# to leave.
run_element() {
  local program=$1 stage=$2 worker='' asked='' code
  shift 2
  trap 'asked=yes; [ -z "$worker" ] || kill -TERM "$worker" 2> /dev/null' INT TERM
  while :; do
    "$program" worker "$stage" --threads "${SLURM_CPUS_PER_TASK:-1}" --wait 600 "$@" &
    worker=$!
    # A signal ends only the wait. The worker's exit code is kept for the wait after its end.
    while kill -0 "$worker" 2> /dev/null; do wait "$worker" || true; done
    code=0
    wait "$worker" || code=$?
    if [ "$code" -ne 3 ] || [ -n "$asked" ]; then exit "$code"; fi
    sleep 5 &
    wait $! || true
    [ -z "$asked" ] || exit "$code"
  done
}

# Starts the run and waits for its end. A request to stop is passed on to the run, which obeys and
# reports. Sets `code` to the run's exit code.
run=
code=0
see_run_through() {
  trap '[ -z "$run" ] || kill -TERM "$run" 2> /dev/null' INT TERM HUP
  "$MESHFARM" run "$MESHFARM_STAGE" "$@" &
  run=$!
  while kill -0 "$run" 2> /dev/null; do wait "$run" || true; done # as in run_element
  wait "$run" || code=$?
}

# The job of the allocation: program, stage, run options, --, the options of its workers.
run_allocation() {
  MESHFARM=$1
  MESHFARM_STAGE=$2
  shift 2
  local options=() workers word=$MESHFARM_STAGE.slurm-$SLURM_JOB_ID.code
  while [ "$1" != -- ]; do options+=("$1"); shift; done
  shift
  # Where the environment is not passed on, srun has no PATH to find bash in.
  srun --no-kill --kill-on-bad-exit=0 --wait=0 --ntasks-per-node=1 \
    "$BASH" -c "$(declare -f run_element); run_element \"\$@\"" run_element \
    "$MESHFARM" "$MESHFARM_STAGE" "$@" &
  workers=$!
  see_run_through "${options[@]}"
  echo "$code" > "$word.tmp"
  mv "$word.tmp" "$word"
  # Workers leave by themselves when the run is over, but srun would wait for those of lost nodes.
  sleep 2
  kill -TERM "$workers" 2> /dev/null || true
  exit "$code"
}

case "${1:-}" in
  --element) shift; run_element "$@" ;;
  --allocation) shift; run_allocation "$@" ;;
esac

# shellcheck source=scripts/launch-common.sh
. "$(dirname "${BASH_SOURCE[0]}")/launch-common.sh"
case "${1:-}" in
  array | allocation) shape=$1 ;;
  --help | -h) print_usage; exit 0 ;;
  *) fail_usage "the shape is 'array' or 'allocation'" ;;
esac
[[ ${2:-} =~ ^[1-9][0-9]*$ ]] || fail_usage "the number of ${shape/array/worker}s is missing"
count=$2
shift 2
sbatch_options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do sbatch_options+=("$1"); shift; done
shift || fail_usage "-- and the STAGE are missing"
[ $# -ge 1 ] || fail_usage "STAGE is missing after --"
command -v sbatch > /dev/null || { echo "launch-slurm.sh: there is no Slurm here (sbatch)" >&2; exit 1; }
MESHFARM=$(find_meshfarm)
MESHFARM_STAGE=$(realpath "$1")
shift
words=$(worker_words "$MESHFARM_STAGE" "$@") || exit $?
mapfile -t words <<< "$words"
self=$(realpath "${BASH_SOURCE[0]}")
sbatch_options=(--parsable --requeue --open-mode=append --job-name=meshfarm
  --output="$MESHFARM_STAGE.slurm-%A.log" ${sbatch_options[@]+"${sbatch_options[@]}"})

job=
# shellcheck disable=SC2317 # reached by the traps
cancel() {
  [ -z "$job" ] || scancel "$job" 2> /dev/null || true
}

launch_array() {
  trap cancel EXIT
  job=$(sbatch "${sbatch_options[@]}" --array=1-"$count" "$self" --element "$MESHFARM" \
    "$MESHFARM_STAGE" \
    "${words[@]}")
  job=${job%%;*}
  echo "launch-slurm.sh: job array $job, $count workers, log $MESHFARM_STAGE.slurm-$job.log" >&2
  see_run_through "$@"
  exit "$code"
}

# The state of the job in the queue; empty once Slurm has forgotten it.
job_state() {
  squeue --noheader --jobs "$job" --format %T 2> /dev/null || true
}

launch_allocation() {
  trap 'cancel; echo "launch-slurm.sh: cancelled; the same command goes on from there" >&2; exit 3' \
    INT TERM HUP
  job=$(sbatch "${sbatch_options[@]}" --nodes="$count" --no-kill "$self" --allocation \
    "$MESHFARM" "$MESHFARM_STAGE" "$@" -- \
    "${words[@]}")
  job=${job%%;*}
  local log=$MESHFARM_STAGE.slurm-$job.log word=$MESHFARM_STAGE.slurm-$job.code
  echo "launch-slurm.sh: job $job on $count nodes, log $log" >&2
  while [ ! -e "$word" ]; do
    case "$(job_state)" in
      PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED | REQUEUE_HOLD | RESIZING) ;;
      *) break ;;
    esac
    sleep 1 &
    wait $! # so that a trap does not have to wait for the end of the sleep
  done
  # A shared folder may show the file late: listing the folder makes an NFS client ask again.
  for _ in 1 2 3 4 5; do
    ls "$(dirname "$word")" > /dev/null
    [ ! -e "$word" ] || break
    sleep 1
  done
  [ ! -e "$log" ] || cat "$log"
  if [ ! -e "$word" ]; then
    echo "launch-slurm.sh: job $job ended before the run did; the same command goes on from there" >&2
    exit 3
  fi
  code=$(cat "$word")
  rm -f "$word"
  exit "$code"
}

"launch_$shape" "$@"
