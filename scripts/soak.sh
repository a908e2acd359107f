#!/usr/bin/env bash
# Kills (SIGKILL), asks to leave (SIGTERM) and stops (SIGSTOP, then SIGCONT) the ventilator, sink
# and workers of small real runs at random moments, restarts those that left, and compares each
# result with that of an undisturbed run.
#   soak.sh [RUNS] [FIRST_SEED] [BUILD_FOLDER] [here|farm]
# 300 runs from seed 1, of build/; "farm": the input is cut and the result finished by jobs.
# Says "300 runs, 0 bad" and exits 0 if every run ended with the same bytes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=${3:-$root/build}/meshfarm
[ -x "$program" ] || { echo "soak.sh: $program is missing; build with scripts/build.sh" >&2; exit 2; }
exec python3 "$root/tests/farm/soak.py" "$program" "${1:-300}" "${2:-1}" "${4:-here}"
