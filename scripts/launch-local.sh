#!/usr/bin/env bash
# A run on this machine alone: ventilator, sink and one worker a core.
#   launch-local.sh [--workers N] STAGE RUN-OPTIONS...
#   launch-local.sh /stage/lucy --ratio 0.01 -o lucy-1pct.ply
# Interrupted (Ctrl-C) it leaves a stage that the same command takes up. Exit codes are those of
# 'meshfarm run': 0 done, 1 failed, 2 wrong usage, 3 incomplete but resumable.
set -euo pipefail
# shellcheck source=scripts/launch-common.sh
. "$(dirname "${BASH_SOURCE[0]}")/launch-common.sh"

workers=$(nproc)
case "${1:-}" in
  --workers)
    [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || fail_usage "--workers: at least 1"
    workers=$2
    shift 2 ;;
  --help | -h) print_usage; exit 0 ;;
esac
[ $# -ge 1 ] || fail_usage "STAGE is missing"
meshfarm=$(find_meshfarm)
# As an option of the run, --workers may be anywhere.
for word in "$@"; do
  [[ $word != --workers && $word != --workers=* ]] || exec "$meshfarm" run "$@" --bind 127.0.0.1
done
exec "$meshfarm" run "$@" --bind 127.0.0.1 --workers "$workers"
