#!/usr/bin/env bash
# Boots a User-Mode Linux kernel (an ordinary process) on this machine's root by hostfs, with a real
# NFS server and two real NFS clients of it (init.sh), and runs a script in it:
#   boot.sh VERSION SECONDS SCRIPT [ARGUMENT...]
# The exit code is the script's; 124 if it took longer than SECONDS, 98 if the kernel itself stood
# still, 99 if it did not get that far.
set -euo pipefail
version=$1
seconds=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modules=$(find /usr/lib/uml/modules -mindepth 1 -maxdepth 1 | head -n 1)
mkdir -p /lib/modules
ln -sfn "$modules" "/lib/modules/$(basename "$modules")"
work=$(mktemp -d "${TMPDIR:-/tmp}/meshfarm-uml.XXXXXX")
trap 'rm -rf "$work"' EXIT
truncate -s 64M "$work/disk"
{
  printf 'NFS_VERSION=%q\nNFS_CODE=%q\nNFS_PULSE=%q\n' "$version" "$work/code" "$work/pulse"
  printf 'NFS_COMMAND=('
  printf ' %q' "$@"
  printf ' )\n'
} > "$work/job"
linux.uml mem=1G "umid=$(basename "$work")" "uml_dir=$work" \
  "ubda=$work/disk" root=/dev/root rootfstype=hostfs rootflags=/ rw "init=$here/init.sh" \
  con=null con0=fd:0,fd:1 quiet "NFS_JOB=$work/job" < /dev/null &
kernel=$!
started=$(($(date +%s) - SECONDS))
code=
since=0
while kill -0 $kernel 2> /dev/null; do
  [ ! -e "$work/pulse" ] || since=$(($(stat -c %Y "$work/pulse") - started))
  if [ $SECONDS -ge "$seconds" ]; then
    code=124
  elif [ $((SECONDS - since)) -ge 60 ]; then
    code=98
  fi
  # Together with the processes in which it runs its own.
  [ -z "$code" ] || pkill -KILL -f "umid=$(basename "$work")"
  sleep 1
done
wait $kernel || true
exit "${code:-$(cat "$work/code" 2> /dev/null || echo 99)}"
