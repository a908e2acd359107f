#!/usr/bin/env bash
# Shared by the labs, which source it. A lab runs the real program on the real thing: hosts in
# network namespaces, Slurm, NFS. Each is called with the program, leaves nothing behind, and exits
# 77 with a reason when skipped. With CI=true only what the kernel or the container forbids is
# skipped.
set -euo pipefail

lab=$(basename "$0" .sh)
lab_here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck disable=SC2034 # for those who source this
lab_root=$(cd "$lab_here/../.." && pwd)
[ -x "${1:-}" ] || { echo "usage: $lab.sh PROGRAM" >&2; exit 2; }
MESHFARM=$(realpath "$1")
export MESHFARM
# Not below /tmp/x: some of the labs' daemons require that root owns every folder above them.
work=$(mktemp -d "${TMPDIR:-/tmp}/meshfarm-lab.XXXXXX")

# Something is missing that could be installed or set up.
skip() {
  [ "${CI:-}" != true ] || fail "cannot be set up: $1"
  echo "SKIPPED $lab: $1"
  exit 77
}
# The kernel or the container forbids it, whatever is installed.
skip_forbidden() {
  echo "SKIPPED $lab: not allowed here: $1"
  exit 77
}
fail() {
  echo "FAILED $lab: $1"
  exit 1
}
say() {
  printf '%6.1f s  %s\n' "$(($(date +%s%N) / 1000000 - lab_start))e-3" "$1"
}
lab_start=$(($(date +%s%N) / 1000000))

need_root() {
  [ "$(id -u)" -eq 0 ] || skip "it needs root"
}
need_commands() {
  local command
  for command in "$@"; do
    command -v "$command" > /dev/null ||
      skip "there is no $command here ('scripts/packages.sh --lab' installs what the labs need)"
  done
}

# Makes a mesh of $1 triangles, and its undisturbed result $work/expected.ply; cuts it into $2 parts
# in the folder $3.
make_stage() {
  local triangles=$1 parts=$2 stage=$3
  [ -e "$work/mesh.ply" ] ||
    "$MESHFARM" generate -o "$work/mesh.ply" --triangles "$triangles" --quiet
  if [ ! -e "$work/expected.ply" ]; then
    "$MESHFARM" simplify "$work/mesh.ply" -o "$work/expected.ply" --ratio 0.05 --parts "$parts" \
      --quiet > /dev/null
  fi
  "$MESHFARM" cut "$work/mesh.ply" --stage "$stage" --parts "$parts" --quiet > /dev/null
}
check_result() {
  cmp "$1" "${2:-$work/expected.ply}" || fail "other bytes than undisturbed: $1"
}
# Makes a stage in the folder $2 whose first run is to cut the mesh (made before) into $1 parts by
# jobs; and the result for the target of $farmed, cut by one process: $work/expected-farmed.ply.
farmed=(--ratio 0.2 --finish farm --composition sink)
make_farmed_stage() {
  [ -e "$work/expected-farmed.ply" ] ||
    "$MESHFARM" simplify "$work/mesh.ply" -o "$work/expected-farmed.ply" --parts "$1" --cut here \
      "${farmed[@]}" --quiet > /dev/null
  "$MESHFARM" cut "$work/mesh.ply" --stage "$2" --parts "$1" --cut farm --blocks 6 --quiet > /dev/null
}

# Waits at most $1 seconds for the command that follows to succeed.
wait_for() {
  local until=$((SECONDS + $1))
  shift
  until "$@"; do
    [ "$SECONDS" -lt "$until" ] || return 1
    sleep 0.1
  done
}
has_results() { # STAGE COUNT
  [ "$(find "$1/results" -type f ! -name '.*' 2> /dev/null | wc -l)" -ge "$2" ]
}

# A copy of our program whose every fsync takes $2 milliseconds, so that a run on small parts lasts
# a while without using up the machine's cores.
make_slow_program() {
  cat > "$1" << END
#!/usr/bin/env bash
exec strace -D -f --seccomp-bpf -qq -o /dev/null -e trace=fsync \
  -e inject=fsync:delay_exit=$(($2 * 1000)) $(printf %q "$MESHFARM") "\$@"
END
  chmod +x "$1"
}

# Hosts in network namespaces, $hosts_prefix1 ... N at 10.77.0.1 ... N, on a bridge of their own.
hosts_prefix=mf$$-
hosts_up() {
  local i host
  { echo '127.0.0.1 localhost'; for i in $(seq "$1"); do echo "10.77.0.$i $hosts_prefix$i"; done; } \
    > "$work/etc-hosts"
  ip netns add "${hosts_prefix}sw"
  ip -n "${hosts_prefix}sw" link add br0 type bridge
  ip -n "${hosts_prefix}sw" link set br0 up
  for i in $(seq "$1"); do
    host=$hosts_prefix$i
    ip netns add "$host"
    ip -n "${hosts_prefix}sw" link add "v$i" type veth peer name eth0 netns "$host"
    ip -n "${hosts_prefix}sw" link set "v$i" master br0 up
    ip -n "$host" addr add "10.77.0.$i/24" dev eth0
    ip -n "$host" link set eth0 up
    ip -n "$host" link set lo up
  done
}
hosts_down() {
  local name
  for name in $(ip netns list | awk -v p="$hosts_prefix" 'index($1, p) == 1 { print $1 }'); do
    kill_host "${name#"$hosts_prefix"}" 2> /dev/null || true
    ip netns del "$name" || true
  done
}
# Not with 'ip netns exec', which mounts /sys anew: slurmd would miss its cgroups.
on_host() { # NUMBER COMMAND...
  local name=$hosts_prefix$1
  shift
  # shellcheck disable=SC2016 # for the inner shell
  nsenter --net="/run/netns/$name" unshare --uts --mount -- \
    bash -c 'hostname "$1"; mount --bind "$2" /etc/hosts; shift 2; exec "$@"' _ "$name" \
    "$work/etc-hosts" "$@"
}
kill_host() { # NUMBER
  ip netns pids "$hosts_prefix$1" | xargs -r kill -KILL
}
cut_off() { # NUMBER
  on_host "$1" iptables -A INPUT -i eth0 -j DROP
  on_host "$1" iptables -A OUTPUT -o eth0 -j DROP
}
heal() { # NUMBER
  on_host "$1" iptables -F
}
