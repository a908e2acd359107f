#!/usr/bin/env bash
# The Debian package in a bare Debian 12: apt installs it, then a run, the manual and the
# completion.
#   lab_deb.sh PROGRAM BUILD_FOLDER
# shellcheck source=tests/lab/lab.sh
. "$(dirname "${BASH_SOURCE[0]}")/lab.sh"
export PATH=$PATH:/usr/sbin:/sbin
need_root
need_commands debootstrap cpack chroot unshare
root=$work/root
# shellcheck disable=SC2317 # reached by the trap
clean_up() {
  rm -rf --one-file-system "$work"
}
trap clean_up EXIT

say "a bare Debian 12"
debootstrap --variant=minbase bookworm "$root" > "$work/debootstrap.log" 2>&1 || {
  tail -n 5 "$work/debootstrap.log"
  ! grep -qiE 'mknod|not permitted' "$work/debootstrap.log" || skip_forbidden "debootstrap"
  skip "debootstrap makes no Debian here (offline?)"
}
say "the package"
cpack --config "$2/CPackConfig.cmake" -B "$work/package" > "$work/cpack.log" 2>&1 ||
  { cat "$work/cpack.log"; fail "no package"; }
cp "$work"/package/meshfarm_*.deb "$root/"

# In the new root, with a /proc as in any container.
in_root() {
  # shellcheck disable=SC2016 # for the shells inside
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C DEBIAN_FRONTEND=noninteractive \
    unshare --mount bash -ec 'mount -t proc proc "$1/proc"; exec chroot "$1" bash -ec "$2"' _ "$root" '
    # Bare images leave out manuals; here they are wanted.
    rm -f /etc/dpkg/dpkg.cfg.d/*
    apt-get update
    apt-get install -y --no-install-recommends /meshfarm_*.deb man-db bash-completion
    cd /tmp
    meshfarm generate -o in.ply --triangles 20000 --quiet
    meshfarm simplify in.ply -o out.ply --ratio 0.1 --quiet
    meshfarm info out.ply
    meshfarm cut in.ply --stage stage --parts 2
    timeout 5 meshfarm status stage --serve 0 | grep localhost
    man meshfarm-simplify | grep -q -- "--ratio"
    . /usr/share/bash-completion/bash_completion
    _completion_loader meshfarm || [ $? -eq 124 ]
    complete -p meshfarm
    '
}
say "apt install and a run"
in_root > "$work/inside.log" 2>&1 || { tail -n 20 "$work/inside.log"; fail "in the bare Debian"; }
grep 'Euler' "$work/inside.log"
say "done"
