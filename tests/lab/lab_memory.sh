#!/usr/bin/env bash
# A real control group of 2 GB, nearly all of it page cache: two workers start in it, each takes its
# share of the memory that the cache can give back, and none is killed for memory.
#   lab_memory.sh PROGRAM
# shellcheck source=tests/lab/lab.sh
. "$(dirname "${BASH_SOURCE[0]}")/lab.sh"
need_root
need_commands python3

groups=/sys/fs/cgroup
if [ -d $groups/memory ]; then
  group=$groups/memory/meshfarm-lab-$$
  limit=memory.limit_in_bytes used=memory.usage_in_bytes killed=memory.oom_control
else
  group=$groups/meshfarm-lab-$$
  limit=memory.max used=memory.current killed=memory.events
fi
# shellcheck disable=SC2317 # reached by the trap
clean_up() {
  if [ -d "$group" ]; then
    xargs -r kill -KILL < "$group/cgroup.procs" 2> /dev/null || true
    wait_for 10 rmdir "$group" 2> /dev/null || true
  fi
  rm -rf "$work"
}
trap clean_up EXIT
mkdir "$group" 2> "$work/refused" || skip_forbidden "no control group: $(cat "$work/refused")"
{ echo $((2 << 30)) > "$group/$limit"; } 2> "$work/refused" ||
  skip_forbidden "no limit of memory: $(cat "$work/refused")"
in_group() {
  bash -c 'echo $$ > "$0/cgroup.procs" && exec "$@"' "$group" "$@"
}
has_room() {
  [ $((2 << 30)) -lt $(($(df --output=avail -B 1 "$work" | tail -n 1))) ]
}
has_room || skip "there is no room for 2 GB in $work"

make_stage 1000000 16 "$work/stage"
say "1.9 GB of page cache"
in_group dd if=/dev/zero of="$work/cache" bs=1M count=1900 conv=fsync status=none
[ "$(cat "$group/$used")" -gt 1800000000 ] || fail "the page cache is not there: $(cat "$group/$used")"

say "two workers"
pids=()
for i in 1 2; do
  in_group "$MESHFARM" worker "$work/stage" --threads 1 -q > "$work/worker.$i" 2>&1 &
  pids+=($!)
done
in_group "$MESHFARM" run "$work/stage" --ratio 0.05 -o "$work/out.ply" --bind 127.0.0.1 -q \
  > "$work/run" 2>&1 || fail "the run's code is $?: $(cat "$work"/run "$work"/worker.*)"
for i in 0 1; do
  wait "${pids[$i]}" || fail "a worker's code is $?: $(cat "$work"/worker.*)"
done
check_result "$work/out.ply"
python3 - "$work/stage" << 'END' || fail "a worker was given no memory to speak of"
import glob, json, sys
joined = {}
for path in glob.glob(sys.argv[1] + "/log/*.trace"):
    for line in map(json.loads, open(path)):
        if line["kind"] == "joined":
            joined[line["pid"]] = line["memory"]
print("          memory of the workers:", *(f"{m >> 20} MiB" for m in joined.values()))
sys.exit(len(joined) != 2 or min(joined.values()) < 500 << 20)
END
if grep -E '^oom_kill [1-9]' "$group/$killed"; then fail "somebody was killed for memory"; fi
say "done, the same bytes, nobody killed"
