#!/usr/bin/env bash
# A run on hosts that plain ssh reaches: ventilator and sink here, a worker on each host.
#   launch-ssh.sh [--hosts FILE] [HOST[:THREADS] ...] -- STAGE RUN-OPTIONS...
#   launch-ssh.sh pc1 pc2:4 pc3 -- /nfs/stage/lucy --ratio 0.01 -o lucy-1pct.ply
# FILE has a HOST[:THREADS] a line, # begins a comment. THREADS are the parts simplified at once
# (default: the host's cores). All hosts see the stage at the same path, and no password is asked.
# The workers end when the run does, when this script does, however it ends, or when the connection
# is lost; a connection that is lost is made again. What workers say goes to STAGE.HOST.log here.
#   MESHFARM         the program (default: the one built beside this script)
#   MESHFARM_REMOTE  the program on the hosts (default: at the same path)
#   MESHFARM_SSH     the ssh command, as "ssh -p 2222"
# Exit codes are those of 'meshfarm run': 0 done, 1 failed, 2 wrong usage, 3 incomplete, resumable.
set -euo pipefail
# shellcheck source=scripts/launch-common.sh
. "$(dirname "${BASH_SOURCE[0]}")/launch-common.sh"

hosts=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  case "$1" in
    --hosts)
      [ -r "${2:-}" ] || fail_usage "--hosts: can't read '${2:-}'"
      mapfile -t -O ${#hosts[@]} hosts < <(sed 's/#.*//; s/[[:space:]]//g; /^$/d' "$2")
      shift ;;
    --help | -h) print_usage; exit 0 ;;
    -*) fail_usage "unknown option $1 (options of the run stand after --)" ;;
    *) hosts+=("$1") ;;
  esac
  shift
done
[ ${#hosts[@]} -gt 0 ] || fail_usage "no hosts are given"
shift || fail_usage "-- and the STAGE are missing"
[ $# -ge 1 ] || fail_usage "STAGE is missing after --"
for host in "${hosts[@]}"; do
  [[ $host =~ ^[A-Za-z0-9_@.-]+(:[1-9][0-9]*)?$ ]] || fail_usage "'$host' is no HOST[:THREADS]"
done
meshfarm=$(find_meshfarm)
remote=${MESHFARM_REMOTE:-$meshfarm}
read -ra ssh_command <<< "${MESHFARM_SSH:-ssh}"
stage=$(realpath "$1")
shift
words=$(worker_words "$stage" "$@") || exit $?
mapfile -t words <<< "$words"

# What a host runs: a worker that is told to leave once nothing holds the other end of stdin.
remote_command() {
  local command word
  command="$(quoted "$remote") worker $(quoted "$stage") --threads $1"
  for word in "${words[@]}"; do command+=" $(quoted "$word")"; done
  # A background process has no stdin of its own, so the watch reads the shell's as another
  # descriptor.
  # shellcheck disable=SC2016 # for the host's shell
  printf 'exec 3<&0; %s < /dev/null 3<&- & worker=$!; %s & watch=$!; %s' "$command" \
    '{ cat <&3 > /dev/null; kill -TERM $worker; } 2> /dev/null' \
    'wait $worker; code=$?; kill $watch 2> /dev/null; exit $code'
}

work=$(mktemp -d)
mkfifo "$work/alive"
# This script holds the writing end, and every ssh reads: however this script ends, they see the end
# of file. Opened for both first, as opening one end waits for the other.
alive=$work/alive
exec 8<> "$alive"
exec 9> "$alive"
exec 8<&-

# Keeps a worker on the host until the run is over.
tend() {
  local host=${1%%:*} threads pause=1 code=0
  # shellcheck disable=SC2016 # the host's cores, not ours
  threads='"$(nproc)"'
  [[ $1 == *:* ]] && threads=${1##*:}
  local log=$stage.$host.log
  : > "$log"
  while [ ! -e "$work/over" ]; do
    code=0
    "${ssh_command[@]}" -o BatchMode=yes -o ServerAliveInterval=15 -o ServerAliveCountMax=4 "$host" \
      "sh -c $(quoted "$(remote_command "$threads")")" < "$alive" >> "$log" 2>&1 || code=$?
    [ ! -e "$work/over" ] || return 0
    case $code in
      0) return 0 ;;
      2 | 126 | 127) # wrong usage, or no such program there: trying again won't help
        echo "launch-ssh.sh: no worker on $host: $(tail -n 1 "$log") (see MESHFARM_REMOTE)" >&2
        return 0 ;;
    esac
    echo "launch-ssh.sh: the worker on $host left ($code: $(tail -n 1 "$log")); tried again" >&2
    sleep $pause
    pause=$((pause < 30 ? 2 * pause : 30))
  done
}

tenders=()
run=
# shellcheck disable=SC2317 # reached by the trap
finish() {
  trap - EXIT
  touch "$work/over"
  exec 9>&- # the workers leave
  local give_up=$((SECONDS + 15))
  while [ -n "$(jobs -pr)" ] && [ "$SECONDS" -lt "$give_up" ]; do sleep 0.2; done
  [ ${#tenders[@]} -eq 0 ] || kill "${tenders[@]}" 2> /dev/null || true
  rm -rf "$work"
}
trap finish EXIT
trap '[ -z "$run" ] || kill -TERM "$run" 2> /dev/null' INT TERM HUP

"$meshfarm" run "$stage" "$@" 9>&- &
run=$!
for host in "${hosts[@]}"; do
  tend "$host" 9>&- &
  tenders+=($!)
done
# A signal ends only the wait, not the run, which is told to leave and reports its result. Its exit
# code is kept for the wait after its end.
while kill -0 "$run" 2> /dev/null; do wait "$run" || true; done
code=0
wait "$run" || code=$?
exit $code
