#!/usr/bin/env bash
# Makes the Debian package, and checks its contents and the unpacked manual and completion.
#   test_package.sh BUILD_FOLDER
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "test_package.sh: $1" >&2
  exit 1
}
cpack --config "$1/CPackConfig.cmake" -B "$work" > "$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
mapfile -t packages < <(find "$work" -maxdepth 1 -name 'meshfarm_*.deb')
[ ${#packages[@]} -eq 1 ] || fail "made ${#packages[@]} packages"
dpkg-deb --field "${packages[0]}" Depends | grep -q libzmq5 || fail "does not depend on libzmq5"
dpkg-deb --field "${packages[0]}" Depends | grep -q libcpp-httplib || fail "has no module that serves"
dpkg-deb --extract "${packages[0]}" "$work/root"
[ ! -e "$work/root/usr/include" ] || fail "has the library's headers"
program=$work/root/usr/bin/meshfarm
pages=$work/root/usr/share/man/man1

for command in '' $("$program" help | awk '/^  [a-z]+ /{print "-" $1}' | grep -v -- '-meshfarm'); do
  page=$pages/meshfarm$command.1
  [ -s "$page" ] || fail "no $page"
  if command -v groff > /dev/null; then
    groff -man -Tascii -ww -z "$page" 2> "$work/groff" || true
    [ ! -s "$work/groff" ] || { cat "$work/groff" >&2; fail "$page is not clean"; }
  fi
done
grep -q 'crease\\-angle' "$pages/meshfarm-simplify.1" || fail "a page without its options"

# complete WORD...: what Tab offers after these words.
complete_words() {
  # shellcheck disable=SC2016 # for the inner shell
  bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); compopt() { :; }
    _meshfarm; echo "${COMPREPLY[*]}"' _ "$work/root/usr/share/bash-completion/completions/meshfarm" "$@"
}
expect() { # WHAT WORD...
  local what=$1 got
  shift
  got=$(complete_words "$@")
  [ "$got" = "$what" ] || fail "after '$*' completion offers '$got', not '$what'"
}
expect "simplify simulate" meshfarm sim
expect "ventilator" meshfarm help v
expect "--topology" meshfarm simplify in.ply --top
expect "auto keep simplify" meshfarm simplify --topology ''
expect "stream" meshfarm cut --scheme st
expect "stream" meshfarm cut --scheme = st
expect "" meshfarm simplify --output ''
