#!/usr/bin/env bash
# Fuzzes every parser: fuzz.sh [SECONDS EACH, default 600] [TARGET ...]
# Findings are kept in build-fuzz/findings; the exit code is 1 if there is any.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
seconds=${1:-600}
[ $# -gt 0 ] && shift
"$root/scripts/packages.sh" --fuzz
build=$root/build-fuzz
"$root/scripts/build.sh" "$build" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DMESHFARM_FUZZ=ON -DMESHFARM_TESTS=OFF -DMESHFARM_SANITIZE=address,undefined
mkdir -p "$build/findings"
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for program in "$build"/tests/fuzz/fuzz_*; do
    [ -x "$program" ] && [ -f "$program" ] && targets+=("$(basename "$program")")
  done
fi

fuzz_one() {
  local target=$1
  local corpus=$build/corpus/$target
  mkdir -p "$corpus"
  local seeds=$root/tests/fuzz/corpus/${target#fuzz_}
  local folders=("$corpus")
  [ -d "$seeds" ] && folders+=("$seeds")
  if "$build/tests/fuzz/$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 \
    -artifact_prefix="$build/findings/$target-" -print_final_stats=1 "${folders[@]}" \
    > "$build/$target.log" 2>&1; then
    echo "$target: no finding, $(grep -o 'number_of_executed_units: .*' "$build/$target.log")"
  else
    echo "$target: FINDING, see $build/$target.log"
    return 1
  fi
}
export -f fuzz_one
export root build seconds
printf '%s\n' "${targets[@]}" | xargs -P "${FUZZ_JOBS:-$(nproc)}" -I{} bash -c 'fuzz_one {}'
