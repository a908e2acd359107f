#!/usr/bin/env bash
# Sets up, builds and runs the tests.
#   test.sh          every test of the release build
#   test.sh --all    also what CI runs: warnings as errors, the labs (tests/lab), all tests compiled
#                    by clang under ASan and UBSan, those of the farm and of what draws under TSan,
#                    and lint.sh
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
all=no
for word in "$@"; do
  case "$word" in
    --all) all=yes ;;
    --quick) ;; # what is the default now
    *) echo "usage: test.sh [--all]" >&2; exit 2 ;;
  esac
done
jobs=$(nproc)
build_options=(-DMESHFARM_TESTS=ON)
[ "$all" = no ] || build_options+=(-DCMAKE_COMPILE_WARNING_AS_ERROR=ON)

begin() {
  printf '\n== %s (after %d min %d s)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60))
}

release() {
  begin "release build"
  "$root/scripts/build.sh" "$root/build" "${build_options[@]}"
  begin "release tests"
  ctest --test-dir "$root/build" --output-on-failure -j "$jobs" --label-exclude lab
}

# One after the other: each has daemons and time limits of its own. They wait for most of their time.
labs() {
  begin "labs"
  local log=$root/build/labs.log code=0
  ctest --test-dir "$root/build" --output-on-failure --label-regex lab | tee "$log" || code=$?
  printf 'labs: %d ran, %d skipped (the kernel or the container forbids them), %d failed\n' \
    "$(grep -c 'Test.*lab\..*   Passed' "$log")" "$(grep -c 'Test.*lab\..*Skipped' "$log")" \
    "$(grep -cE 'Test.*lab\..*(Failed|Timeout|Not Run)' "$log")"
  return "$code"
}

# compile FOLDER SANITIZERS [TARGET...]. By clang: g++ takes five times as long for sanitizers.
compile() {
  "$root/scripts/build.sh" "$root/$1" "${build_options[@]}" -DCMAKE_CXX_COMPILER=clang++ \
    -DCMAKE_BUILD_TYPE=RelWithDebInfo -DMESHFARM_UNITY=ON -DMESHFARM_SANITIZE="$2" -- "${@:3}"
}

compile_beside_labs() {
  renice -n 10 "$BASHPID" > /dev/null
  compile build-asan address,undefined
}

# sanitized FOLDER SANITIZERS TESTS [TARGET...]: TESTS is a regular expression.
sanitized() {
  begin "tests with $2"
  compile "$1" "$2" "${@:4}"
  ctest --test-dir "$root/$1" --output-on-failure -j "$jobs" --tests-regex "$3"
}

packages=(--npm)
[ "$all" = no ] || packages+=(--lab --lint --fuzz)
"$root/scripts/packages.sh" "${packages[@]}"
dragon=$root/data/dragon_vrip.ply.gz
mkdir -p "$root/data"
[ -s "$dragon" ] || "$root/scripts/get-dragon.sh" "$dragon" ||
  echo "test.sh: without the dragon its test is skipped" >&2

release
if [ "$all" = yes ]; then
  # The labs wait for most of their time: meanwhile what follows is compiled.
  log=$root/build/compiled-beside.log
  trap 'kill $(jobs -p) 2> /dev/null || true' EXIT
  compile_beside_labs > "$log" 2>&1 &
  compiling=$!
  labs
  wait "$compiling" || { cat "$log" >&2; exit 1; }
  sanitized build-asan address,undefined .
  # TSan does not see into libzmq, which is not built with it.
  TSAN_OPTIONS=ignore_noninstrumented_modules=1 \
    sanitized build-tsan thread '^unit\.(util|staging|farm|transport|simulation|render)$' \
    test_util test_staging test_farm test_transport test_simulation test_render
  begin "lint"
  "$root/scripts/lint.sh"
fi
begin "all tests passed"
