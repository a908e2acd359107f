#!/usr/bin/env bash
# Sets up, builds and runs every test: the release build, then the same under ASan and UBSan.
#   test.sh            all of it
#   test.sh --quick    the release build only
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
quick=no
for word in "$@"; do
  case "$word" in
    --quick) quick=yes ;;
    *) echo "usage: test.sh [--quick]" >&2; exit 2 ;;
  esac
done
"$root/scripts/packages.sh" --npm
dragon=$root/data/dragon_vrip.ply.gz
mkdir -p "$root/data"
[ -s "$dragon" ] || "$root/scripts/get-dragon.sh" "$dragon" ||
  echo "test.sh: without the dragon its test is skipped" >&2

"$root/scripts/build.sh" "$root/build" -DMESHFARM_TESTS=ON
ctest --test-dir "$root/build" --output-on-failure
if [ "$quick" = no ]; then
  "$root/scripts/build.sh" "$root/build-asan" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DMESHFARM_SANITIZE=address,undefined
  ctest --test-dir "$root/build-asan" --output-on-failure
fi
