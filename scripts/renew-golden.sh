#!/usr/bin/env bash
# Rewrites the golden checksums (tests/golden/checksums.txt), after a version was raised:
#   renew-golden.sh [--force] [BUILD_FOLDER]       of build/
# If bytes have changed under the same version, nothing is written: raise the version that is named,
# and run this again. --force writes them anyway.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
renew=yes
if [ "${1:-}" = --force ]; then
  renew=force
  shift
fi
build=${1:-$root/build}
cmake --build "$build" --target test_golden
MESHFARM_RENEW_GOLDEN=$renew "$build/tests/test_golden"
git -C "$root" diff --stat -- tests/golden
