#!/usr/bin/env bash
# From a fresh Debian 12 to a simplified Stanford dragon: installs what is missing, builds, gets the
# dragon (871,414 triangles) and takes it to 1 % on all cores. Quick when run again.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
scripts/packages.sh --npm
scripts/build.sh build -DMESHFARM_TESTS=OFF
meshfarm=build/meshfarm

mkdir -p data
input=data/dragon_vrip.ply.gz
if [ ! -s "$input" ] && ! scripts/get-dragon.sh "$input"; then
  echo "demo.sh: the dragon can't be had (offline?): a procedural mesh is made instead" >&2
  input=data/generated.ply
  [ -s "$input" ] || "$meshfarm" generate -o "$input" --triangles 900000
fi
output=data/demo-1pct.ply
rm -rf "$output.stage"
echo "+ $meshfarm simplify $input -o $output --ratio 0.01"
"$meshfarm" simplify "$input" -o "$output" --ratio 0.01
echo "+ $meshfarm compare $input $output"
"$meshfarm" compare "$input" "$output"
