#!/usr/bin/env bash
# Measures meshfarm beside its peers, and prints one table:
#   bench.sh [--peers all|NAME,...] [--runs N] [--ratio R] [--workers N] [--install] [--kernel] INPUT.ply
#   bench.sh --attributes [--runs N] [--ratio R] [--workers N] [--install] INPUT.ply
#   bench.sh --corpus FOLDER [--ratios R,...] [--peers all|NAME,...] [--workers N] [--install]
#   --peers    meshoptimizer (Debian's and npm's), cgal (both of its methods), openmesh, vtk,
#              meshlab, or none: those that are installed are run, the others are named (default:
#              all but meshlab, which is slow)
#   --runs     rounds; the programs take turns in each, and medians are shown (default: 5)
#   --ratio    how much of the input is kept (default: 0.01)
#   --workers  of the whole runs of meshfarm (default: 2)
#   --install  first installs the peers: Debian packages, and meshoptimizer's newest from npm
#   --kernel   also runs the microbenchmarks; without INPUT.ply only these
#   --attributes  colours the mesh, once with noise and once with stripes, and measures beside the
#              peers that keep colours: meshoptimizer of npm, VTK and MeshLab (file to file)
#   --corpus   every mesh of FOLDER (.ply, .ply.gz, .ply.zst), to every ratio, by both schemes
#   --ratios   of the corpus (default: 0.5,0.1,0.03,0.01,0.003)
# The rows "file to file" are whole runs: everything from the start of the program to its end. The
# others time the simplification alone, of a mesh that is read and cleaned before.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build-bench
known=(meshoptimizer meshoptimizer_npm cgal_lindstrom_turk cgal_garland_heckbert openmesh vtk
  meshlab_file)
npm_version=1.3.0

fail_usage() {
  echo "bench.sh: $1" >&2
  sed -n '3,5s/^# *//p' "$0" >&2
  exit 2
}

peers=all runs=5 ratio=0.01 workers=2 install=no kernel=no attributes=no input=
corpus='' ratios=0.5,0.1,0.03,0.01,0.003
while [ $# -gt 0 ]; do
  case "$1" in
    --peers | --runs | --ratio | --workers | --corpus | --ratios)
      [ $# -gt 1 ] || fail_usage "$1 needs a value"
      declare "${1#--}=$2"
      shift ;;
    --install) install=yes ;;
    --kernel) kernel=yes ;;
    --attributes) attributes=yes ;;
    --help | -h) sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0"; exit 0 ;;
    -*) fail_usage "unknown option $1" ;;
    *) [ -z "$input" ] || fail_usage "one INPUT.ply only"; input=$1 ;;
  esac
  shift
done
[[ $runs =~ ^[1-9][0-9]*$ ]] || fail_usage "--runs: at least 1"
[[ $workers =~ ^[1-9][0-9]*$ ]] || fail_usage "--workers: at least 1"
[ -n "$input$corpus" ] || [ "$kernel" = yes ] || fail_usage "INPUT.ply is missing"
[ -z "$input" ] || [ -z "$corpus" ] || fail_usage "either INPUT.ply or --corpus"
[ -z "$corpus" ] || [ -d "$corpus" ] || fail_usage "--corpus: $corpus is no folder"
[ -z "$input" ] || [ -r "$input" ] || fail_usage "can't read $input"

install_peers() {
  local sudo=()
  [ "$(id -u)" -eq 0 ] || sudo=(sudo)
  "$root/scripts/packages.sh" --npm
  DEBIAN_FRONTEND=noninteractive "${sudo[@]}" apt-get install -y --no-install-recommends \
    libmeshoptimizer-dev libcgal-dev libopenmesh-dev libvtk9-dev libbenchmark-dev libeigen3-dev \
    meshlab xvfb xauth \
    > "$build/install.log" 2>&1 ||
    { tail -n 5 "$build/install.log" >&2; echo "bench.sh: could not install the peers" >&2; exit 1; }
  npm install --prefix "$build/npm" "meshoptimizer@$npm_version" > "$build/npm.log" 2>&1 ||
    { tail -n 5 "$build/npm.log" >&2; echo "bench.sh: npm has no meshoptimizer for us" >&2; exit 1; }
}

# The names of the peers to run. Those requested but not built are reported on stderr.
choose_peers() {
  local name word
  for name in "${known[@]}"; do
    for word in ${peers//,/ }; do
      [ "$word" = all ] && [ "$name" != meshlab_file ] || [[ $name == "$word"* ]] || continue
      if [ -x "$build/tests/bench/peer_$name" ]; then
        echo "$name"
      else
        echo "bench.sh: $name is left out: it is not installed (--install gets it)" >&2
      fi
      break
    done
  done
}

check_peer_words() {
  local word name found
  for word in ${peers//,/ }; do
    found=no
    for name in "${known[@]}" all; do [[ $name == "$word"* ]] && found=yes; done
    [ "$found" = yes ] || [ "$word" = none ] || fail_usage "--peers: unknown peer $word"
  done
}

# One run of one program. NAME.ROUND.tree has what the whole process tree used, .peer the program's
# output.
run_one() {
  local name=$1 round=$2 output=$results/$1.ply
  local command=("$build/tests/bench/peer_$name" "$input" "$output" "$ratio")
  if [ "$name" = meshfarm_file ]; then
    rm -rf "$output.stage"
    command=("$build/meshfarm" simplify "$input" -o "$output" --ratio "$ratio"
      --workers "$workers" --quiet)
  fi
  echo "round $round: $name" >&2
  "$build/tests/bench/measure_tree" "$results/$name.$round.tree" "${command[@]}" \
    > "$results/$name.$round.peer" 2> "$results/$name.log" && return
  echo "bench.sh: $name failed: $(tail -n 1 "$results/$name.log")" >&2
  touch "$results/$name.failed"
}

# For the colours of large meshes, `compare` needs more memory than its default.
compare_one() {
  "$build/meshfarm" compare "$input" "$results/$1.ply" --memory 4G --json \
    > "$results/$1.compare" || touch "$results/$1.failed"
}

check_peer_words
mkdir -p "$build"
[ "$install" = no ] || install_peers
"$root/scripts/build.sh" "$build" -DMESHFARM_BENCH=ON -DMESHFARM_TESTS=OFF \
  -DCMAKE_BUILD_TYPE=Release > "$build/build.log" 2>&1 || { tail -n 30 "$build/build.log" >&2; exit 1; }
if [ "$kernel" = yes ]; then
  [ -x "$build/tests/bench/bench_kernel" ] ||
    { echo "bench.sh: Google Benchmark is not installed (--install gets it)" >&2; exit 1; }
  "$build/tests/bench/bench_kernel"
fi
if [ "$attributes" = yes ]; then
  [ -n "$input" ] || fail_usage "--attributes: INPUT.ply is missing"
  for kind in noise stripes; do
    coloured=$build/$(basename "${input%.ply}")-$kind.ply
    "$build/tests/bench/colour_mesh" "$input" "$coloured" "$kind"
    "$0" --peers meshoptimizer_npm,vtk,meshlab --runs "$runs" --ratio "$ratio" \
      --workers "$workers" "$coloured"
  done
  exit 0
fi
mapfile -t names < <(choose_peers)
if [ -n "$corpus" ]; then
  [[ " ${names[*]} " != *" meshoptimizer "* ]] || names+=(meshoptimizer_file)
  exec python3 "$root/tests/bench/corpus.py" "$corpus" --build "$build" --ratios "$ratios" \
    --workers "$workers" --peers "${names[@]}"
fi
[ -n "$input" ] || exit 0

results=$build/results
rm -rf "$results"
mkdir -p "$results"
own=()
! head -c 4096 "$input" | grep -aq 'property [a-z0-9]* red' || own=(meshfarm_shape meshfarm_fitted)
names=(meshfarm "${own[@]}" "${names[@]}" meshfarm_file)
[[ " ${names[*]} " != *" meshoptimizer "* ]] || names+=(meshoptimizer_file)

cat "$input" > /dev/null # so that the first program does not pay for the disk
load_before=$(cut -d ' ' -f 1 /proc/loadavg)
for ((round = 1; round <= runs; ++round)); do
  for name in "${names[@]}"; do
    [ -e "$results/$name.failed" ] || run_one "$name" "$round"
  done
done
load_after=$(cut -d ' ' -f 1 /proc/loadavg)
for name in "${names[@]}"; do
  [ -e "$results/$name.failed" ] || compare_one "$name"
done

echo "$(basename "$input") at ratio $ratio, medians of $runs round(s), $workers workers," \
  "$(nproc) cores, load average $load_before before and $load_after after"
echo
python3 "$root/tests/bench/bench_table.py" "$results" "${names[@]}"
