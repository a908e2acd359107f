# SPDX-FileCopyrightText: 2026 the meshfarm authors
# SPDX-License-Identifier: MIT
"""Runs meshfarm and its peers over a folder of meshes and prints one markdown table; called by
scripts/bench.sh --corpus.

Each mesh is simplified to each ratio by both schemes of meshfarm and by each peer. What the peers
do is remembered in peers.json beside the results, so that a second run costs meshfarm's time only.
"""
import argparse
import json
import math
import pathlib
import shutil
import subprocess
import sys

ENDINGS = (".ply", ".ply.gz", ".ply.zst")
SCHEMES = ("cut", "stream")
FILE_TO_FILE = "meshoptimizer_file"  # whole runs, as meshfarm's: the measure of time, not of error
# A peer that leaves more triangles than were asked for has an easier task: no fair comparison.
MOST_OF_ASKED = 1.02
# As a fraction of the diagonal: half a unit in the last place of a float of that size. Anything
# below counts as exact.
FINEST_RMS = 2.0 ** -25
HEAD = ["mesh", "kept", "scheme", "asked", "reached", "RMS 1e-6", "max 1e-6", "CPU s",
        "best peer", "its RMS 1e-6", "RMS / best", "CPU / meshoptimizer"]


class Failure(Exception):
    """One run of one program gave no result."""


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--ratios", type=lambda text: text.replace(",", " ").split())
    parser.add_argument("--workers", default="2")
    parser.add_argument("--timeout", type=float, default=300, help="seconds a run")
    parser.add_argument("--peers", nargs="*", default=[])
    return parser.parse_args()


def run(command, timeout):
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    except subprocess.TimeoutExpired:
        raise Failure(f"took over {timeout:.0f} s") from None
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise Failure(lines[-1])
    return json.loads(done.stdout)


def name_of(path):
    return path.name[:path.name.index(".ply")]


class Bench:
    """The programs of one build, and where their results go."""

    def __init__(self, arguments):
        self.arguments = arguments
        self.build = arguments.build
        self.programs = arguments.build / "tests/bench"
        self.results = arguments.build / "corpus"
        self.results.mkdir(exist_ok=True)
        self.output = self.results / "result.ply"
        self.memory = self.results / "peers.json"
        self.known = json.loads(self.memory.read_text()) if self.memory.exists() else {}

    def run(self, command):
        self.output.unlink(missing_ok=True)
        return run([str(word) for word in command], self.arguments.timeout)

    def clean(self, path):
        """A copy without doubles, that all peers read, and its number of triangles."""
        copy = self.results / (name_of(path) + ".clean.ply")
        said = self.run([self.programs / "peer_clean", path, copy, "1"])
        return copy, said["triangles"]

    def measure(self, original):
        said = self.run_compare(original)
        ways = (said["a_to_b"], said["b_to_a"])
        return {"rms": max(way["rms"] for way in ways), "max": max(way["max"] for way in ways),
                "triangles": said["topology_b"]["triangles"]}

    def run_compare(self, original):
        words = [self.build / "meshfarm", "compare", original, self.output, "--json"]
        return run([str(word) for word in words], None)

    def meshfarm(self, path, original, ratio, scheme):
        report = self.results / "tree.json"
        shutil.rmtree(f"{self.output}.stage", ignore_errors=True)
        said = self.run([self.programs / "measure_tree", report, self.build / "meshfarm",
                         "simplify", path, "-o", self.output, "--ratio", ratio, "--scheme", scheme,
                         "--workers", self.arguments.workers, "--quiet", "--json"])
        took = json.loads(report.read_text())
        return self.measure(original) | {"asked": said["target"], "cpu": took["cpu_s"]}

    def peer(self, name, original, ratio):
        """What the peer reaches, or why it does not. Failures are remembered too."""
        size = original.stat().st_size
        key = f"{original.name} {size} {ratio} {name}"
        if key not in self.known:
            print(f"  {name}", file=sys.stderr)
            try:
                said = self.run([self.programs / f"peer_{name}", original, self.output, ratio])
                self.known[key] = self.measure(original) | {"cpu": said["cpu_s"]}
            except Failure as failure:
                self.known[key] = {"failed": str(failure)}
            new = self.memory.with_suffix(".new")
            new.write_text(json.dumps(self.known, indent=0))
            new.rename(self.memory)
        return self.known[key]


class Row:
    """One mesh to one ratio by one scheme, beside the peers."""

    def __init__(self, mesh, ratio, scheme, peers):
        self.mesh, self.ratio, self.scheme = mesh, ratio, scheme
        self.peers = {name: said for name, said in peers.items() if "failed" not in said}
        self.mine, self.failed = None, None

    def best_peer(self):
        """Of those with a task as hard."""
        fair = [(said["rms"], name) for name, said in self.peers.items() if name != FILE_TO_FILE
                and said["triangles"] <= MOST_OF_ASKED * self.mine["asked"]]
        return min(fair, default=None)

    def rms_ratio(self):
        """None also where too many triangles are left: that is no result to be proud of."""
        if self.mine is None or self.mine["triangles"] > MOST_OF_ASKED * self.mine["asked"]:
            return None
        best = self.best_peer()
        return best and max(self.mine["rms"], FINEST_RMS) / max(best[0], FINEST_RMS)

    def cpu_ratio(self):
        reference = self.peers.get(FILE_TO_FILE)
        return reference and self.mine["cpu"] / max(reference["cpu"], 1e-3)

    def cells(self):
        start = [self.mesh, self.ratio, self.scheme]
        if self.failed is not None:
            return start + [f"failed: {self.failed}"] + [""] * (len(HEAD) - 4)
        mine, best = self.mine, self.best_peer()
        return start + [
            f"{mine['asked']:,}", f"{mine['triangles']:,}", millionths(mine["rms"]),
            millionths(mine["max"]), f"{mine['cpu']:.2f}", best[1] if best else "none",
            millionths(best[0]) if best else "", two_places(self.rms_ratio()),
            two_places(self.cpu_ratio())]


def two_places(ratio):
    return "" if ratio is None else f"{ratio:.2f}"


def millionths(value):
    scaled = value * 1e6
    return f"{scaled:,.0f}" if scaled >= 1000 else f"{scaled:.3g}"


def count_is_met(row):
    """Never more; at most 0.1 % fewer, 2 % where under a thousand are asked for."""
    asked, reached = row.mine["asked"], row.mine["triangles"]
    fewest = asked * (0.98 if asked < 1000 else 0.999)
    return fewest - 1 <= reached <= asked


def measure_mesh(bench, path):
    original, triangles = bench.clean(path)
    rows = []
    for ratio in bench.arguments.ratios:
        print(f"{name_of(path)}, {triangles:,} triangles, {ratio} kept", file=sys.stderr)
        peers = {name: bench.peer(name, original, ratio) for name in bench.arguments.peers}
        for scheme in SCHEMES:
            row = Row(name_of(path), ratio, scheme, peers)
            rows.append(row)
            try:
                row.mine = bench.meshfarm(path, original, ratio, scheme)
            except Failure as failure:
                row.failed = failure
    original.unlink()
    return rows


def print_table(rows):
    for line in [HEAD, ["---"] * 3 + ["---:"] * (len(HEAD) - 3)] + [row.cells() for row in rows]:
        print("| " + " | ".join(line) + " |")


def print_summary(rows):
    done = [row for row in rows if row.mine]
    rated = [row for row in done if row.rms_ratio() is not None]
    off = [row for row in done if not count_is_met(row)]
    print(f"\n{len(done)} of {len(rows)} rows have a result; {len(off)} miss the count that was "
          "asked for, and have no ratio if they are far above it.")
    if not rated:
        return
    worst = max(rated, key=Row.rms_ratio)
    mean = math.exp(sum(math.log(row.rms_ratio()) for row in rated) / len(rated))
    print(f"RMS / best peer: worst {worst.rms_ratio():.2f} ({worst.mesh}, {worst.ratio}, "
          f"{worst.scheme}), geometric mean {mean:.2f} of {len(rated)} rows; "
          f"{sum(row.rms_ratio() > 1 for row in rated)} above 1.")
    print("RMS and max: the greater of both directions, in millionths of the diagonal; the best "
          f"peer is among those that left at most {MOST_OF_ASKED} of the count.")
    print("CPU: whole runs, file to file; beside meshoptimizer's where that is installed.")


def main():
    arguments = parse_arguments()
    meshes = sorted(path for path in arguments.folder.iterdir() if path.name.endswith(ENDINGS))
    if not meshes:
        sys.exit(f"bench.sh: no {', '.join(ENDINGS)} in {arguments.folder}")
    bench = Bench(arguments)
    rows = []
    for path in meshes:
        try:
            rows += measure_mesh(bench, path)
        except Failure as failure:
            print(f"bench.sh: {path}: {failure}", file=sys.stderr)
    print_table(rows)
    print_summary(rows)
    return 1 if not rows or any(row.failed for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
