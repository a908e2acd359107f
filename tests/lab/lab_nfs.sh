#!/usr/bin/env bash
# Whole runs on real NFS, versions 3 and 4.2, between the kernel's own server and clients in
# User-Mode Linux (nfs/boot.sh), with ventilator and workers on two clients; then with the disk full
# or slow, the server restarted or away, and the links cut (nfs/scenario.sh).
#   lab_nfs.sh PROGRAM
# shellcheck source=tests/lab/lab.sh
. "$(dirname "${BASH_SOURCE[0]}")/lab.sh"
export PATH=$PATH:/usr/sbin:/sbin
need_root
need_commands linux.uml strace python3 modprobe mkfs.ext4 rpcbind exportfs rpc.mountd rpc.nfsd mount.nfs ip tc
[ -d /usr/lib/uml/modules ] || skip "the modules of User-Mode Linux are missing"
trap 'rm -rf "$work"' EXIT
"$lab_here/nfs/boot.sh" 4.2 60 /bin/true > "$work/boot.log" 2>&1 ||
  skip_forbidden "User-Mode Linux does not boot here: $(tail -n 1 "$work/boot.log")"

make_stage 60000 24 "$work/stage"
make_farmed_stage 8 "$work/farmed"
# A kernel that stands still (98) says nothing about the program: it is booted once more.
run_scenario() { # VERSION
  local try code
  for try in 1 2; do
    echo "NFS $1: boot $try" >> "$work/log.$1"
    code=0
    "$lab_here/nfs/boot.sh" "$1" 700 "$lab_here/nfs/scenario.sh" "$MESHFARM" "$work/stage" \
      "$work/expected.ply" "$work/mesh.ply" "$work/expected-farmed.ply" "${farmed[@]}" \
      >> "$work/log.$1" 2>&1 || code=$?
    [ $code -eq 98 ] || break
  done
  return $code
}
failed=
pids=()
for version in 3 4.2; do
  run_scenario $version &
  pids+=($!)
done
for i in 0 1; do wait "${pids[$i]}" || failed+=" $?"; done
grep -h 'NFS ' "$work/log.3" "$work/log.4.2" || true
if [ -n "$failed" ]; then
  tail -n 40 "$work/log.3" "$work/log.4.2"
  fail "codes$failed"
fi
