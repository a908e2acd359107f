#!/usr/bin/env bash
# Boots a User-Mode Linux kernel, an ordinary process, that has this machine's root by hostfs, a real
# NFS server and two real NFS clients of it (init.sh), and runs a script in it:
#   boot.sh VERSION SECONDS SCRIPT [ARGUMENT...]
# The exit code is the script's; 124 if it took longer than SECONDS, 99 if the kernel did not get so far.
set -euo pipefail
version=$1
seconds=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modules=$(find /usr/lib/uml/modules -mindepth 1 -maxdepth 1 | head -n 1)
mkdir -p /lib/modules
[ -e "/lib/modules/$(basename "$modules")" ] || ln -s "$modules" /lib/modules/
work=$(mktemp -d "${TMPDIR:-/tmp}/meshfarm-uml.XXXXXX")
trap 'rm -rf "$work"' EXIT
truncate -s 64M "$work/disk"
{
  printf 'NFS_VERSION=%q\nNFS_CODE=%q\n' "$version" "$work/code"
  printf 'NFS_COMMAND=('
  printf ' %q' "$@"
  printf ' )\n'
} > "$work/job"
code=0
timeout -k 5 "$seconds" linux.uml mem=1G "umid=$(basename "$work")" "uml_dir=$work" \
  "ubda=$work/disk" root=/dev/root rootfstype=hostfs rootflags=/ rw "init=$here/init.sh" \
  con=null con0=fd:0,fd:1 quiet "NFS_JOB=$work/job" < /dev/null || code=$?
[ $code -eq 124 ] || [ $code -eq 137 ] || code=$(cat "$work/code" 2> /dev/null || echo 99)
exit "$code"
