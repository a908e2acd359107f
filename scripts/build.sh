#!/usr/bin/env bash
# Builds meshfarm: build.sh FOLDER [CMAKE OPTION ...] [-- TARGET ...]   (quick when nothing has changed)
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$1
shift
options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  options+=("$1")
  shift
done
[ $# -eq 0 ] || shift
targets=()
[ $# -eq 0 ] || targets=(--target "$@")
launcher=()
command -v ccache > /dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
log=$(mktemp)
if ! cmake -G Ninja -S "$root" -B "$folder" "${launcher[@]}" "${options[@]}" > "$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
rm -f "$log"
cmake --build "$folder" "${targets[@]}"
