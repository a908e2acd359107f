#!/usr/bin/env bash
# Checks the form of our code: shellcheck, clang-format and clang-tidy.
#   lint.sh           all three
#   lint.sh --format  clang-format only
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
mapfile -t scripts < <(git ls-files '*.sh' .ci/run)
[ "${1:-}" = --format ] || shellcheck -x "${scripts[@]}"
mapfile -t files < <(git ls-files '*.cpp' '*.hpp')
clang-format --dry-run -Werror "${files[@]}"
[ "${1:-}" = --format ] && exit 0
# Sources are checked several together: most of the time of clang-tidy goes into the headers. What
# calls other simplifiers is left out: not every machine has them.
cmake -G Ninja -S . -B build-lint -DCMAKE_CXX_COMPILER=clang++ -DMESHFARM_TESTS=OFF \
  -DMESHFARM_BENCH=ON -DMESHFARM_UNITY=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON > /dev/null
mapfile -t sources < <(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' build-lint/compile_commands.json |
  grep -vE '/peers/(cgal|openmesh|vtk|meshoptimizer)')
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build-lint --quiet
