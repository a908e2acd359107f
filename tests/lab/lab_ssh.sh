#!/usr/bin/env bash
# Four hosts reached by ssh, in network namespaces. One is cut off for ten seconds in the middle of
# a run that launch-ssh.sh started, then reconnected: the bytes are the same, its jobs go to others
# in time, and no worker is left when the launcher ends or is killed.
#   lab_ssh.sh PROGRAM
# shellcheck source=tests/lab/lab.sh
. "$(dirname "${BASH_SOURCE[0]}")/lab.sh"
need_root
need_commands ip iptables nsenter sshd ssh ssh-keygen strace

# shellcheck disable=SC2317 # reached by the trap
clean_up() {
  hosts_down
  rm -rf "$work"
}
trap clean_up EXIT
hosts_up 5 2> "$work/hosts.log" || skip_forbidden "no network namespaces: $(tail -n 1 "$work/hosts.log")"

start_sshd() {
  local i
  mkdir -p /run/sshd
  ssh-keygen -q -t ed25519 -N '' -f "$work/hostkey"
  ssh-keygen -q -t ed25519 -N '' -f "$work/id"
  cp "$work/id.pub" "$work/authorized_keys"
  for i in 2 3 4 5; do
    printf 'Host host%s\n HostName 10.77.0.%s\n User root\n' "$i" "$i"
    printf ' %s\n' "IdentityFile $work/id" 'IdentitiesOnly yes' 'LogLevel ERROR' \
      "UserKnownHostsFile $work/known_hosts" 'StrictHostKeyChecking yes'
    echo "10.77.0.$i $(cut -d ' ' -f 1,2 "$work/hostkey.pub")" >> "$work/known_hosts"
    on_host "$i" "$(command -v sshd)" -f /dev/null -o "ListenAddress=10.77.0.$i" \
      -o "HostKey=$work/hostkey" -o "AuthorizedKeysFile=$work/authorized_keys" -o PidFile=none \
      -o UsePAM=no -o StrictModes=no -o PasswordAuthentication=no -E "$work/sshd.log"
  done > "$work/ssh_config"
}
export MESHFARM_SSH="ssh -F $work/ssh_config"
export MESHFARM_REMOTE=$work/slow-meshfarm
make_slow_program "$MESHFARM_REMOTE" 250

workers_left() {
  pgrep -f "meshfarm worker $stage" > /dev/null
}
no_workers_left() {
  ! workers_left
}
no_run_left() {
  ! pgrep -f "$MESHFARM run $stage" > /dev/null
}
# Prefixes each line with the time of its arrival.
stamped() {
  local line
  while IFS= read -r line; do echo "$(($(date +%s%N) / 1000000)) $line"; done
}

start_sshd
stage=$work/stage
make_stage 200000 120 "$stage"
printf 'host2:1\nhost3:1  # a comment\n' > "$work/hosts"

say "a run on four hosts"
# On a terminal, progress is shown five times a second.
command="'$lab_root/scripts/launch-ssh.sh' --hosts '$work/hosts' host4:1 host5:1 -- '$stage' \
  --ratio 0.05 -o '$work/out.ply' --bind 10.77.0.1; echo \"code \$?\""
on_host 1 script -qfc "$command" /dev/null < /dev/null | stdbuf -o0 tr '\r' '\n' | stamped \
  > "$work/run.log" &
launcher=$!
wait_for 30 grep -q ' 4 workers' "$work/run.log" || fail "not four workers: $(cat "$work/run.log")"
wait_for 30 has_results "$stage" 20 || fail "no results: $(cat "$work/run.log")"
say "host 3 is cut off"
cut=$(($(date +%s%N) / 1000000))
cut_off 3
sleep 10
heal 3
say "host 3 is back"
wait $launcher || true
grep -q ' code 0' "$work/run.log" || fail "the run failed: $(cat "$work/run.log" "$stage".*.log)"
check_result "$work/out.ply"
away=$(awk '/ given out again/ { print $1; exit }' "$work/run.log")
[ -n "$away" ] || fail "no job was given out again: $(cat "$work/run.log")"
say "done, the same bytes; host 3's jobs were elsewhere after $((away - cut)) ms"
# Three heartbeats of one second each since the last one heard, the ventilator's look at the clock,
# and half a second between two lines of progress.
[ $((away - cut)) -le 4200 ] || fail "that is more than three heartbeats"
wait_for 20 no_workers_left || fail "workers are left after the run"

say "a launcher that is killed takes its workers along; cut and finish are jobs from here on"
make_farmed_stage 24 "$stage-2"
stage=$stage-2
# Not through on_host: its processes could not be killed by a single process id.
on_host 1 setsid "$lab_root/scripts/launch-ssh.sh" host2:1 host3:1 -- "$stage" "${farmed[@]}" \
  -o "$work/out2.ply" --bind 10.77.0.1 > /dev/null 2>&1 &
wait_for 30 has_results "$stage" 5 || fail "no results of the second run"
pkill -KILL -f "launch-ssh.sh host2:1 host3:1 -- $stage"
wait_for 30 no_workers_left || fail "workers outlive a killed launcher"

say "an interrupted one leaves a stage that the same command takes up"
pkill -TERM -f "$MESHFARM run $stage" || true
# It releases the output for the next run only when it has ended.
wait_for 20 no_run_left || fail "a run that was asked to leave is still there"
# The launcher is delayed after it has passed the signal on: its run may have ended by then.
on_host 1 strace -o /dev/null -e trace=kill -e inject=kill:delay_exit=500000 \
  "$lab_root/scripts/launch-ssh.sh" host2:1 host3:1 -- "$stage" "${farmed[@]}" \
  -o "$work/out2.ply" --bind 10.77.0.1 > /dev/null 2> "$work/run2.err" &
launcher=$!
wait_for 30 has_results "$stage" 40 || fail "no results of the third run: $(cat "$work/run2.err")"
say "it is interrupted"
pkill -TERM -o -f "^bash .*launch-ssh.sh host2:1 host3:1 -- $stage"
code=0
wait $launcher || code=$?
[ $code -eq 3 ] || fail "an interrupted launcher's code is $code: $(cat "$work/run2.err")"
wait_for 5 no_workers_left || fail "workers outlive an interrupted launcher"
say "it is taken up"
on_host 1 "$lab_root/scripts/launch-ssh.sh" host2:1 host3:1 -- "$stage" "${farmed[@]}" \
  -o "$work/out2.ply" --bind 10.77.0.1 > /dev/null 2>&1 || fail "the run was not taken up"
check_result "$work/out2.ply" "$work/expected-farmed.ply"
say "done"
