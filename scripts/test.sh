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
# Most tests spend much of their time waiting; under sanitizers they compute.
jobs=$(($(nproc) * 2 + 1))
sanitized_jobs=$(($(nproc) + 1))
build_options=(-DMESHFARM_TESTS=ON)
if [ "$all" = no ]; then
  # Compiles sources of a layer together and optimises a little less, which halves the time.
  release_build=$root/build-test
  build_options+=(-DMESHFARM_UNITY=ON "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG")
else
  # As users build it.
  release_build=$root/build
  build_options+=(-DCMAKE_COMPILE_WARNING_AS_ERROR=ON)
fi

begin() {
  printf '\n== %s (after %d min %d s)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60))
}

release() {
  begin "release build"
  "$root/scripts/build.sh" "$release_build" "${build_options[@]}"
  begin "release tests"
  ctest --test-dir "$release_build" --output-on-failure -j "$jobs" --label-exclude lab
}

# One after the other: each has its own daemons and time limits. They spend most of their time
# waiting.
labs() {
  begin "labs"
  local log=$release_build/labs.log code=0
  ctest --test-dir "$release_build" --output-on-failure --label-regex lab | tee "$log" || code=$?
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

# sanitized FOLDER SANITIZERS CHOICE TESTS [TARGET...]: CHOICE is an option of ctest that selects by
# TESTS, a regular expression.
sanitized() {
  begin "tests with $2 ($3 $4)"
  compile "$1" "$2" "${@:5}"
  ctest --test-dir "$root/$1" --output-on-failure -j "$sanitized_jobs" "$3" "$4"
}

beside_labs() {
  renice -n 19 "$BASHPID" > /dev/null
  sanitized build-asan address,undefined --label-regex unit
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
  # The labs spend most of their time waiting: meanwhile ASan's tests are compiled, and those that
  # only compute are run.
  log=$root/build/beside-labs.log
  trap 'kill $(jobs -p) 2> /dev/null || true' EXIT
  beside_labs > "$log" 2>&1 &
  beside=$!
  labs
  wait "$beside" || { cat "$log" >&2; exit 1; }
  grep '^100% tests passed' "$log"
  sanitized build-asan address,undefined --label-exclude unit
  # TSan cannot see into libzmq, which is not built with it.
  TSAN_OPTIONS=ignore_noninstrumented_modules=1 \
    sanitized build-tsan thread --tests-regex \
    '^unit\.(util|staging|farm|transport|web|simulation|render)$' \
    test_util test_staging test_farm test_transport test_web test_simulation test_render
  begin "lint"
  "$root/scripts/lint.sh"
fi
begin "all tests passed"
