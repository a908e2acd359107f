#!/usr/bin/env bash
# Checks the style of our code: shellcheck, clang-format and clang-tidy.
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
# Several sources are checked together, as clang-tidy spends most of its time on the headers. Code
# that calls other simplifiers is left out, since not every machine has them.
cmake -G Ninja -S . -B build-lint -DCMAKE_CXX_COMPILER=clang++ -DMESHFARM_TESTS=OFF \
  -DMESHFARM_BENCH=ON -DMESHFARM_UNITY=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON > /dev/null
mapfile -t sources < <(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' build-lint/compile_commands.json |
  grep -vE '/peers/(cgal|openmesh|vtk|meshoptimizer)')
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build-lint --quiet
