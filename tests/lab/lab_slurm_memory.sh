#!/usr/bin/env bash
# Slurm's own control groups: a job of 2 GB, nearly all of it page cache, in which two workers start
# as tasks of one step. Each is told the job's memory, they share it, the run takes more than the
# cache leaves, and Slurm kills nobody.
#   lab_slurm_memory.sh PROGRAM
# shellcheck source=tests/lab/lab.sh
. "$(dirname "${BASH_SOURCE[0]}")/lab.sh"
# shellcheck source=tests/lab/slurm.sh
. "$(dirname "${BASH_SOURCE[0]}")/slurm.sh"
need_root
need_commands ip nsenter slurmctld slurmd sbatch scontrol srun munged python3

node=${hosts_prefix}2
# slurmd leaves its groups behind.
# shellcheck disable=SC2317 # reached by the trap
remove_groups() {
  find /sys/fs/cgroup -depth -type d -path "*/slurm_$node*" -exec rmdir {} + 2> /dev/null
}
# shellcheck disable=SC2317 # reached by the trap
clean_up() {
  slurm_down
  wait_for 10 remove_groups || true
  rm -rf "$work"
}
trap clean_up EXIT
hosts_up 2 2> "$work/hosts.log" || skip_forbidden "no network namespaces: $(tail -n 1 "$work/hosts.log")"
[ $((3 << 30)) -lt $(($(df --output=avail -B 1 "$work" | tail -n 1))) ] ||
  skip "there is no room for 3 GB in $work"

mkdir -p "$slurm"
cat > "$slurm/cgroup.conf" << END
CgroupMountpoint=/sys/fs/cgroup
ConstrainRAMSpace=yes
ConstrainSwapSpace=no
IgnoreSystemd=yes
CgroupAutomount=$([ -d /sys/fs/cgroup/memory ] && echo no || echo yes)
END
slurm_up 2 2> "$work/slurm.log" << END || true
ProctrackType=proctrack/cgroup
TaskPlugin=task/cgroup
SelectTypeParameters=CR_Core_Memory
NodeName=$node NodeAddr=10.77.0.2 CPUs=2 RealMemory=4000 State=UNKNOWN
END
wait_for 30 nodes_idle 1 || skip_forbidden "no node of Slurm with control groups: \
$(cat "$work/slurm.log"; grep -h error "$slurm/slurmd-$node.log" | tail -n 1)"

make_stage 6000000 3 "$work/stage"

# The job's script; it writes what its group reports to files in $work.
cat > "$work/job" << 'END'
#!/usr/bin/env bash
work=$1
stage=$work/stage
if [ -d /sys/fs/cgroup/memory ]; then
  group=/sys/fs/cgroup/memory$(sed -n 's/^[0-9]*:memory://p' /proc/self/cgroup)
  limit=memory.limit_in_bytes used=memory.usage_in_bytes killed=memory.oom_control
else
  group=/sys/fs/cgroup$(sed -n 's/^0:://p' /proc/self/cgroup)
  limit=memory.max used=memory.current killed=memory.events
fi
while [[ ${group##*/} != job_* && $group = */*/* ]]; do group=${group%/*}; done
cat "$group/$limit" > "$work/limit"
dd if=/dev/zero of="$work/cache" bs=1M count=1900 conv=fsync status=none
cat "$group/$used" > "$work/used"
srun --overlap --ntasks=2 "$MESHFARM" worker "$stage" --threads 1 -q > "$work/workers" 2>&1 &
workers=$!
"$MESHFARM" run "$stage" --ratio 0.05 -o "$work/out.ply" --bind 127.0.0.1 -q > "$work/run" 2>&1
code=$?
wait $workers || code="$code, of the workers $?"
# In version 1 each group counts its own; of the step's, which are gone, srun has told.
find "$group" -name "$killed" -exec cat {} + > "$work/killed"
echo "$code" > "$work/code.tmp"
mv "$work/code.tmp" "$work/code"
[ "$code" = 0 ]
END
say "a job of 2 GB with 1.9 GB of page cache and two workers"
on_host 1 sbatch --mem=2G --ntasks=2 --output="$work/job.out" "$work/job" "$work" > "$work/sbatch"
job_over() {
  on_host 1 scontrol show job > "$work/state" && ! grep -qE 'JobState=(PENDING|RUNNING|COMPLETING)' "$work/state"
}
wait_for 120 job_over || fail "the job does not end: $(cat "$work/state")"
say "the job is over"
state=$(grep -o 'JobState=[A-Z_]*' "$work/state")
if [ "$state" != JobState=COMPLETED ] || [ "$(cat "$work/code")" != 0 ]; then
  fail "Slurm says $state: $(cd "$work" && tail -n 5 job.out run workers code)"
fi
[ "$(cat "$work/limit")" -eq $((2 << 30)) ] || fail "the job's limit is $(cat "$work/limit")"
[ "$(cat "$work/used")" -gt 1800000000 ] || fail "the page cache is not there: $(cat "$work/used")"
check_result "$work/out.ply"
python3 - "$work/stage" << 'END' || fail "the workers were not given the job's memory together"
import glob, json, sys
joined = {}
jobs = []
for path in glob.glob(sys.argv[1] + "/log/*.trace"):
    for line in map(json.loads, open(path)):
        if line["kind"] == "joined":
            joined[line["pid"]] = line
        if line["kind"] == "done":
            jobs.append(line["memory"])
memory = [line["memory"] for line in joined.values()]
print("          memory of the workers:", *(f"{m >> 20} MiB" for m in memory))
print("          memory of the parts:", *(f"{m >> 20} MiB" for m in jobs))
pools = {line["pool"] for line in joined.values()}
right = len(joined) == 2 and 1500 << 20 < min(memory) and max(memory) < 2 << 30
sys.exit(not (right and len(pools) == 1 and 0 not in pools and max(jobs) > 200 << 20))
END
if grep -E '^oom_kill [1-9]' "$work/killed"; then fail "somebody was killed for memory"; fi
say "done, the same bytes, nobody killed"
