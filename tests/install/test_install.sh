#!/usr/bin/env bash
# Installs the build into a scratch folder and builds a program against it with find_package.
#   test_install.sh BUILD_FOLDER CXX_COMPILER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$1" --prefix "$work/prefix" > /dev/null
cmake -S "$here" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$2" \
  -DCMAKE_BUILD_TYPE=Release > /dev/null
cmake --build "$work/build" > /dev/null
"$work/prefix/bin/meshfarm" generate -o "$work/in.ply" --triangles 5000 --quiet
made=$("$work/build/consumer" "$work/in.ply" "$work/out.ply")
[ "$made" = 1000 ] || { echo "made $made triangles instead of 1000" >&2; exit 1; }
"$work/prefix/bin/meshfarm" info "$work/out.ply" | grep -q 'Euler characteristic 0'
# The module that serves pages is found where it was installed.
"$work/prefix/bin/meshfarm" cut "$work/in.ply" --stage "$work/stage" --parts 2 > /dev/null
"$work/prefix/bin/meshfarm" status "$work/stage" --serve 0 > "$work/served" &
for _ in $(seq 100); do
  sleep 0.1
  [ ! -s "$work/served" ] || break
done
kill -INT $!
wait $!
grep -q '^http://localhost:' "$work/served"
