#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
#
# Draws the pictures in README.md: a mesh, and its simplification to 1 %.
#
#   scripts/picture.sh MESH [FOLDER]     into FOLDER (default: docs); needs build/meshfarm
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
mesh=${1:?"which mesh? scripts/get-dragon.sh gets the dragon"}
folder=${2:-$root/docs}
meshfarm=${MESHFARM:-$root/build/meshfarm}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$meshfarm" simplify "$mesh" -o "$scratch/small.ply" --ratio 0.01 --quiet > "$scratch/log"
view=(--view front --size 600x420 --samples 4 --quiet)
"$meshfarm" render "$mesh" -o "$folder/dragon.png" "${view[@]}"
"$meshfarm" render "$scratch/small.ply" -o "$folder/dragon-1pct.png" "${view[@]}"
