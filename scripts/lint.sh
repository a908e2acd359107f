#!/usr/bin/env bash
# Checks the form of our code: shellcheck, clang-format, and clang-tidy over what scripts/test.sh has
# built.
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
mapfile -t sources < <(git ls-files 'src/*.cpp' 'bin/*.cpp')
# The analyzer goes into called functions as far as its shallow mode does: deeper takes twice as long.
options=(--extra-arg=-Wno-unknown-warning-option)
for word in -Xclang -analyzer-config -Xclang mode=shallow; do options+=("--extra-arg=$word"); done
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy -p build --quiet "${options[@]}"
