#!/usr/bin/env bash
# Shared by the launchers, which source it.

# Reports an error and the launcher's usage, which is in its head comment.
fail_usage() {
  echo "$(basename "$0"): $1" >&2
  print_usage >&2
  exit 2
}
print_usage() {
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"
}

# The program: $MESHFARM, or the one built or installed beside the scripts, or the one in the PATH.
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

# The options of a run that its workers need, too, one per line: worker_words STAGE RUN-OPTIONS...
# The program itself parses the options, in any order, and knows the run's key.
worker_words() {
  "${meshfarm:-${MESHFARM:?}}" run "$@" --worker-words
}

# A word, quoted so that any POSIX shell reads it unchanged.
quoted() {
  printf "'%s'" "${1//\'/\'\\\'\'}"
}
