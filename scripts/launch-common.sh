#!/usr/bin/env bash
# What the launchers share; they source it.

# Says what is wrong and how the launcher is called, which stands in its head comment.
fail_usage() {
  echo "$(basename "$0"): $1" >&2
  print_usage >&2
  exit 2
}
print_usage() {
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"
}

# The program: $MESHFARM, or the one that was built or installed beside the scripts, or in the PATH.
find_meshfarm() {
  local here candidate
  here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
  for candidate in "${MESHFARM:-}" "$here/../build/meshfarm" "$here/meshfarm" \
    "$(command -v meshfarm || true)"; do
    [ -n "$candidate" ] && [ -x "$candidate" ] && { realpath "$candidate"; return; }
  done
  echo "$(basename "$0"): where is meshfarm? Build it (scripts/build.sh build), or set MESHFARM" >&2
  return 1
}

# The words of a run that its workers need too, one a line: worker_words STAGE RUN-OPTIONS...
# The program at hand reads the options, wherever they stand, and knows the run's key.
worker_words() {
  "${meshfarm:-${MESHFARM:?}}" run "$@" --worker-words
}

# A word as any POSIX shell reads it back.
quoted() {
  printf "'%s'" "${1//\'/\'\\\'\'}"
}
