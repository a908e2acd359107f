#!/usr/bin/env bash
# Inside the kernel that boot.sh boots: runs with ventilator and sink on one NFS client and a worker
# on each. First undisturbed, then with the disk full, files that take long to reach the disk, the
# server restarted or away for long, the links cut. Each run ends with the same bytes, or with code
# 3 and then with the same bytes when the same command is given again. What merely takes time must
# neither stop a run nor cost a worker its life.
#   scenario.sh PROGRAM CUT-STAGE EXPECTED.ply MESH.ply EXPECTED-FARMED.ply TARGET...
# The last arguments are of a run whose cut (into 8 parts) and finish are jobs.
set -uo pipefail
meshfarm=$1
cut_stage=$2
expected=$3
mesh=$4
farmed_expected=$5
shift 5
farmed_target=("$@")
target=(--ratio 0.05)
logs=$(mktemp -d)
ventilator_side=/mnt/c1
worker_side=/mnt/c2

fail() {
  echo "FAILED NFS $NFS_VERSION: $1"
  tail -n 5 "$logs"/*
  exit 1
}
say() {
  echo "$(cut -d ' ' -f 1 /proc/uptime) s  NFS $NFS_VERSION: $1"
}
wait_for() { # SECONDS COMMAND...
  local until=$((SECONDS + $1))
  shift
  until "$@"; do
    [ $SECONDS -lt $until ] || return 1
    sleep 0.2
  done
}
# Runs a command that uses a file system; only the file system can keep it from ending.
within() { # SECONDS COMMAND...
  local seconds=$1
  shift
  "$@" &
  local command=$!
  if ! wait_for "$seconds" has_ended $command; then
    dmesg -n 7
    echo w > /proc/sysrq-trigger
    fail "does not end: $*"
  fi
  wait $command
}
# Looks at the server's own disk, as a client would cache the answers.
has_results() { # STAGE COUNT
  [ "$(find "/srv/x/$1/results" -type f ! -name '.*' | wc -l)" -ge "$2" ]
}
has_ended() { # PID
  ! kill -0 "$1" 2> /dev/null
}

new_stage() { # NAME
  within 60 cp -r "$cut_stage" "$ventilator_side/$1" || fail "no room for a stage"
}
# Starts the processes through $launcher; sets run, workers. With $heartbeat_ms ventilator and sink
# are separate processes.
launcher=()
heartbeat_ms=
start() { # STAGE
  workers=()
  local side
  for side in $worker_side $ventilator_side; do
    "${launcher[@]}" "$meshfarm" worker "$side/$1" -q --threads 1 > "$logs/$1.worker.${side##*/}" 2>&1 &
    workers+=($!)
  done
  local collects=run binds=(--bind 127.0.0.1)
  if [ -n "$heartbeat_ms" ]; then
    "${launcher[@]}" "$meshfarm" ventilator "$ventilator_side/$1" "${target[@]}" "${binds[@]}" \
      --heartbeat-ms "$heartbeat_ms" -q > "$logs/$1.ventilator" 2>&1 &
    collects=sink
  fi
  "${launcher[@]}" "$meshfarm" $collects "$ventilator_side/$1" "${target[@]}" \
    -o "$ventilator_side/$1.ply" "${binds[@]}" -q > "$logs/$1.run" 2>&1 &
  run=$!
}
# Waits for the end; sets code.
finish() { # SECONDS
  wait_for "$1" has_ended "$run" || fail "the run does not end"
  code=0
  wait "$run" || code=$?
  kill -TERM "${workers[@]}" 2> /dev/null
  wait_for 30 has_ended "${workers[0]}" || fail "a worker does not end"
  wait_for 30 has_ended "${workers[1]}" || fail "a worker does not end"
}
# After a disturbance: the run is done, or resumable and done on the second try; checks the bytes.
check() { # STAGE
  if [ "$code" -eq 3 ]; then
    say "it stopped, resumable: $(tail -n 1 "$logs/$1.run")"
    start "$1"
    finish 90
  fi
  [ "$code" -eq 0 ] || fail "the code of the run is $code"
  # Through the other client.
  within 60 cmp "$worker_side/$1.ply" "$expected" || fail "other bytes"
  say "the same bytes"
  within 60 rm -rf "${ventilator_side:?}/$1" "$ventilator_side/$1.ply"
}
# The run was done in one go, by the workers that it began with.
unharmed() { # STAGE
  [ "$code" -eq 0 ] || fail "the code of the run is $code"
  # When all is done workers leave without a message.
  python3 - "$ventilator_side/$1"/log/*.trace << 'END' || fail "a worker was given up"
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
end = max(line["t"] for line in lines if line["kind"] == "done")
left = [line for line in lines if line["kind"] == "left" and line["t"] < end]
print(*left, sep="\n", end="")
sys.exit(len(left) != 0)
END
}
says() { # STAGE WORDS
  within 60 "$meshfarm" status "$ventilator_side/$1" > "$logs/$1.status" 2> /dev/null
  grep -q "$2" "$logs/$1.status"
}
fill_disk() {
  fallocate -l 1G /srv/x/filler 2> /dev/null
  # More than once, because whoever finds no room removes what it has begun.
  for filler in 2 3 4; do
    dd if=/dev/zero of=/srv/x/filler$filler bs=4k 2> /dev/null
    sleep 1
  done
}
slow_down() {
  tc qdisc add dev s1 root netem delay "$1"
  tc qdisc add dev s2 root netem delay "$1"
}
cut_link() { # CLIENT SECONDS
  tc qdisc replace dev "s$1" root netem loss 100%
  sleep "$2"
  tc qdisc replace dev "s$1" root netem delay 20ms
}

say "the doctor's word on a hard mount and on a soft one"
new_stage plain
"$meshfarm" doctor $ventilator_side/plain > "$logs/doctor" || fail "a hard mount is called bad"
grep -q "vers=$NFS_VERSION" "$logs/doctor" || fail "the doctor sees no NFS"
case $NFS_VERSION in
  3) mount -t nfs -o vers=3,nolock,mountport=20048,soft 10.9.1.1:/srv/x /media ;;
  *) mount -t nfs -o "vers=$NFS_VERSION,soft" 10.9.1.1:/ /media ;;
esac || fail "no soft mount"
"$meshfarm" doctor /media/plain > "$logs/doctor" && fail "a soft mount is not called bad"
grep -q 'BAD   soft mount' "$logs/doctor" || fail "a soft mount is not found"
"$meshfarm" run /media/plain --ratio 0.05 > "$logs/soft" 2>&1
code=$?
[ $code -eq 1 ] || fail "a soft mount is not refused ($code)"
grep -q 'soft NFS mount' "$logs/soft" || fail "a soft mount is not refused by name"
umount /media

say "an undisturbed run"
start plain
finish 60
check plain

slow_down 20ms
say "the disk is full in the middle of a run"
new_stage full
start full
wait_for 60 has_results full 3 || fail "no results"
within 60 fill_disk
wait_for 30 says full 'no room' || fail "the status says nothing of it"
sleep 60
has_ended "$run" && fail "the run does not wait for room"
within 60 rm -f /srv/x/filler*
finish 150
unharmed full
check full

say "each of the first files takes 20 s to reach the disk"
new_stage late
# The host may be busy, but no thread may be silent for as long as a file takes.
heartbeat_ms=5000
# Counted per thread: both slots of a worker, and the sink's disk thread.
launcher=(strace --seccomp-bpf -D -f -qq -o /dev/null -e trace=fsync -e inject=fsync:delay_exit=20000000:when=2)
start late
launcher=()
heartbeat_ms=
finish 200
unharmed late
check late

say "the server is restarted in the middle of a run"
new_stage restart
start restart
wait_for 60 has_results restart 3 || fail "no results"
rpc.nfsd 0
sleep 3
rpc.nfsd 4
finish 120
check restart

say "the server is away for 90 s"
new_stage away
start away
wait_for 60 has_results away 3 || fail "no results"
rpc.nfsd 0
sleep 90
rpc.nfsd 4
finish 200
unharmed away
check away

say "the worker's link is cut for 20 s"
new_stage link2
start link2
wait_for 60 has_results link2 3 || fail "no results"
cut_link 2 20
finish 120
check link2

say "the ventilator's link is cut for 20 s"
new_stage link1
start link1
wait_for 60 has_results link1 3 || fail "no results"
cut_link 1 20
finish 120
check link1

say "cut and finish are jobs, and the server is restarted while there is something to cut"
expected=$farmed_expected
target=("${farmed_target[@]}")
# The input is on NFS, too: workers check that it is the one that the stage was made for.
cp "$mesh" "$ventilator_side/mesh.ply" || fail "no room for the mesh"
"$meshfarm" cut "$ventilator_side/mesh.ply" --stage "$ventilator_side/farmed" --parts 8 --cut farm \
  --blocks 6 -q > /dev/null || fail "the cut is not planned"
start farmed
wait_for 60 has_results farmed 8 || fail "no results"
rpc.nfsd 0
sleep 3
rpc.nfsd 4
wait_for 60 has_results farmed 40 || fail "no pieces"
kill -KILL "${workers[0]}"
finish 120
check farmed
