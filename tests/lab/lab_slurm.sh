#!/usr/bin/env bash
# A real Slurm on hosts in network namespaces, in both shapes of launch-slurm.sh, with a node killed
# in the middle of each run: the run completes with the same bytes, and no job is left in Slurm.
#   lab_slurm.sh PROGRAM
# shellcheck source=tests/lab/lab.sh
. "$(dirname "${BASH_SOURCE[0]}")/lab.sh"
# shellcheck source=tests/lab/slurm.sh
. "$(dirname "${BASH_SOURCE[0]}")/slurm.sh"
need_root
need_commands ip nsenter slurmctld slurmd sbatch scancel squeue srun munged strace

# shellcheck disable=SC2317 # reached by the trap
clean_up() {
  slurm_down
  rm -rf "$work" 2> /dev/null || { sleep 1; rm -rf "$work"; } # what was killed may write still
}
trap clean_up EXIT
hosts_up 4 2> "$work/hosts.log" || skip_forbidden "no network namespaces: $(tail -n 1 "$work/hosts.log")"

slurm_up 4 2> "$work/slurm.log" << END || skip "Slurm does not start: $(tail -n 1 "$work/slurm.log")"
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectTypeParameters=CR_Core
NodeName=${hosts_prefix}[2-4] NodeAddr=10.77.0.[2-4] CPUs=1 RealMemory=2000 State=UNKNOWN
END
wait_for 30 nodes_idle 3 || fail "no idle nodes: $(on_host 1 sinfo)"
make_slow_program "$work/slow-meshfarm" 250

# A run in one of the shapes, with a node killed once it has some results.
run_shape() { # SHAPE STAGE EXPECTED TARGET...
  local shape=$1 stage=$2 expected=$3 launcher code=0
  shift 3
  say "a run in the shape '$shape' on three nodes"
  # Some sites do not pass the environment on.
  MESHFARM=$work/slow-meshfarm on_host 1 "$lab_root/scripts/launch-slurm.sh" "$shape" 3 \
    --export=NONE -- "$stage" \
    "$@" -o "$stage.ply" > "$stage.out" 2>&1 &
  launcher=$!
  wait_for 60 has_results "$stage" 15 || fail "no results: $(cat "$stage".*)"
  on_host 1 squeue --noheader --states=RUNNING --format '%i on %N' | sed 's/^/          /'
  say "node 4 is killed"
  kill_host 4
  wait $launcher || code=$?
  say "the run is over"
  [ $code -eq 0 ] || fail "the launcher's code is $code: $(cat "$stage".*)"
  check_result "$stage.ply" "$expected"
  wait_for 60 no_jobs || fail "jobs are left: $(on_host 1 squeue)"
  say "done, the same bytes, no job left"
}

make_stage 200000 80 "$work/stage-array"
run_shape array "$work/stage-array" "$work/expected.ply" --ratio 0.05
start_node 4
on_host 1 scontrol update "NodeName=${hosts_prefix}4" State=RESUME 2> /dev/null || true
wait_for 60 nodes_idle 3 || fail "node 4 does not come back: $(on_host 1 sinfo)"
make_farmed_stage 16 "$work/stage-allocation"
run_shape allocation "$work/stage-allocation" "$work/expected-farmed.ply" "${farmed[@]}"
